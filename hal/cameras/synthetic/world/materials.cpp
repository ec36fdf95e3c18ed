#include "hal/cameras/synthetic/world/materials.h"

#include <cmath>
#include <utility>

#include "hal/cameras/synthetic/world/noise.h"
#include "hal/cameras/synthetic/world/srgb.h"

namespace pleinair::hal::synthetic {

Painter plain(std::uint32_t srgb) {
  const glm::vec3 colour = linearFromSrgb(srgb);
  return [colour](Canvas& canvas) {
    canvas.paintAll(
        [&](glm::vec2 p) { return colour * (0.95F + 0.10F * valueNoise(31, p * 6.0F)); });
  };
}

Painter enamel(std::uint32_t srgb) {
  const glm::vec3 colour = linearFromSrgb(srgb);
  return [colour](Canvas& canvas) {
    const glm::vec2 half = canvas.half();
    canvas.paintAll([&](glm::vec2 p) {
      const float edge = boxDistance(p, half);
      const float uneven = valueNoise(33, p * 40.0F);
      const float worn = glm::smoothstep(-0.0030F - 0.0025F * uneven, -0.0008F, edge);
      const glm::vec3 faded = colour * (0.93F + 0.14F * valueNoise(32, p * 7.0F));
      return glm::mix(faded, colour * 0.7F + glm::vec3(0.14F, 0.13F, 0.115F), 0.55F * worn);
    });
  };
}

Painter steel(std::uint32_t srgb) {
  const glm::vec3 colour = linearFromSrgb(srgb);
  return [colour](Canvas& canvas) {
    const glm::vec2 half = canvas.half();
    canvas.paintAll([&](glm::vec2 p) {
      const float gloss = 0.5F + 0.5F * std::sin(2.2F * p.y / half.y + 1.1F * p.x / half.x + 0.6F);
      const float streak = valueNoise(34, {p.x * 12.0F, p.y * 300.0F}) - 0.5F;
      return colour * (0.70F + 0.42F * gloss + 0.06F * streak);
    });
  };
}

Painter polished(std::uint32_t srgb) {
  const glm::vec3 colour = linearFromSrgb(srgb);
  return [colour](Canvas& canvas) {
    const float half = canvas.half().x;
    canvas.paintAll([&](glm::vec2 p) {
      const float angle = 3.14159F * p.x / half;
      const float bands = 0.5F + 0.28F * std::cos(angle + 0.9F) + 0.22F * std::cos(2.0F * angle);
      return colour * (0.45F + 0.95F * bands * bands);
    });
  };
}

Painter board(std::uint32_t srgb, std::uint32_t seed, bool alongY) {
  const glm::vec3 colour = linearFromSrgb(srgb);
  return [=](Canvas& canvas) {
    const auto grain = [&](glm::vec2 p) {
      const float bend = 0.010F * (valueNoise(seed, {p.x * 3.0F, p.y * 9.0F}) - 0.5F);
      return colour *
             (0.78F + 0.40F * fractalNoise(seed + 1, {p.x * 2.4F, (p.y + bend) * 75.0F}, 2));
    };
    if (alongY) {
      canvas.paintAll([&](glm::vec2 p) { return grain({p.y, p.x}); });
    } else {
      canvas.paintAllAlongX(grain);
    }
  };
}

Painter striped(std::uint32_t srgb, std::uint32_t between, float period, float share) {
  const glm::vec3 colour = linearFromSrgb(srgb);
  const glm::vec3 other = linearFromSrgb(between);
  return [=](Canvas& canvas) {
    canvas.paintAll([&](glm::vec2 p) {
      const float phase = std::abs(p.x / period - std::round(p.x / period)) * period;
      return glm::mix(other, colour, canvas.inside(phase - share * period / 2));
    });
  };
}

Painter ringed(std::uint32_t srgb, std::uint32_t between, float period, float share) {
  const glm::vec3 colour = linearFromSrgb(srgb);
  const glm::vec3 other = linearFromSrgb(between);
  return [=](Canvas& canvas) {
    canvas.paintAll([&](glm::vec2 p) {
      const float phase = std::abs(p.y / period - std::round(p.y / period)) * period;
      return glm::mix(other, colour, canvas.inside(phase - share * period / 2));
    });
  };
}

Painter cardboard() {
  const glm::vec3 colour = linearFromSrgb(0xb98f5f);
  const glm::vec3 tape = linearFromSrgb(0xd2b27c);
  return [=](Canvas& canvas) {
    canvas.paintAll([&](glm::vec2 p) {
      const float uneven = 0.92F + 0.16F * valueNoise(36, p * 9.0F);
      return glm::mix(colour * uneven, tape, 0.8F * canvas.inside(std::abs(p.y) - 0.022F));
    });
  };
}

Painter cloth(std::uint32_t srgb) {
  const glm::vec3 colour = linearFromSrgb(srgb);
  return [colour](Canvas& canvas) {
    canvas.paintAll([&](glm::vec2 p) {
      const float slant = p.y + 0.35F * p.x;
      const float folds = fractalNoise(37, {p.x * 9.0F, slant * 17.0F}, 2) - 0.5F;
      return colour * (1.0F + 0.75F * folds);
    });
  };
}

Painter layered(Painter below, Painter above) {
  return [below = std::move(below), above = std::move(above)](Canvas& canvas) {
    below(canvas);
    above(canvas);
  };
}

}  // namespace pleinair::hal::synthetic
