#include "hal/cameras/synthetic/camera_path.h"

#include <chrono>
#include <cmath>
#include <numbers>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "hal/cameras/synthetic/noise.h"

namespace pleinair::hal::synthetic {
namespace {

using std::chrono::milliseconds;

double seconds(Duration time) {
  return std::chrono::duration<double>(time).count();
}

/// OpenCV's camera at `position`, looking at `target`, the world's z up in the picture.
glm::dmat4 lookAt(glm::dvec3 position, glm::dvec3 target) {
  const glm::dvec3 z = glm::normalize(target - position);
  const glm::dvec3 x = glm::normalize(glm::cross(z, glm::dvec3(0, 0, 1)));
  const glm::dvec3 y = glm::cross(z, x);
  const glm::dmat3 worldFromCamera(x, y, z);
  glm::dmat4 cameraFromWorld(glm::transpose(worldFromCamera));
  cameraFromWorld[3] = glm::dvec4(-(glm::transpose(worldFromCamera) * position), 1);
  return cameraFromWorld;
}

}  // namespace

Wander::Wander(std::uint64_t seed, double amplitude, Duration period) {
  constexpr std::array<double, 3> kShare{0.62, 0.26, 0.12};
  constexpr std::array<double, 3> kSpeed{1.0, 1.83, 3.19};
  for (std::size_t i = 0; i < waves_.size(); ++i) {
    const double detune = 0.9 + 0.2 * unitRandom(seed, 2 * i);
    waves_[i] = {amplitude * kShare[i], 2 * std::numbers::pi * kSpeed[i] * detune / seconds(period),
                 2 * std::numbers::pi * unitRandom(seed, 2 * i + 1)};
  }
}

double Wander::at(Duration time) const {
  const double t = seconds(time);
  double sum = 0;
  for (const Wave& wave : waves_) {
    sum += wave.amplitude * std::sin(wave.radiansPerSecond * t + wave.phaseRadians);
  }
  return sum;
}

HandheldPath::HandheldPath(std::uint64_t seed)
    : targetX_(mixBits(seed) + 1, 0.11, milliseconds(9100)),
      targetY_(mixBits(seed) + 2, 0.06, milliseconds(7300)),
      distance_(mixBits(seed) + 3, 0.13, milliseconds(11900)),
      slant_(mixBits(seed) + 4, glm::radians(11.0), milliseconds(10300)),
      azimuth_(mixBits(seed) + 5, glm::radians(32.0), milliseconds(13700)),
      roll_(mixBits(seed) + 6, glm::radians(4.0), milliseconds(6100)),
      trembleBy_{Wander(mixBits(seed) + 7, 0.0012, milliseconds(610)),
                 Wander(mixBits(seed) + 8, 0.0012, milliseconds(530)),
                 Wander(mixBits(seed) + 9, 0.0012, milliseconds(710))},
      trembleTurn_{Wander(mixBits(seed) + 10, glm::radians(0.14), milliseconds(590)),
                   Wander(mixBits(seed) + 11, glm::radians(0.14), milliseconds(670)),
                   Wander(mixBits(seed) + 12, glm::radians(0.14), milliseconds(490))} {}

glm::dmat4 HandheldPath::cameraFromWorld(Duration time) const {
  const glm::dvec3 target(0.02 + targetX_.at(time), 0.03 + targetY_.at(time), 0);
  const double slant = glm::radians(36.0) + slant_.at(time);
  const double azimuth = azimuth_.at(time);
  const double distance = 0.80 + distance_.at(time);
  const glm::dvec3 towardsCamera(std::sin(slant) * std::sin(azimuth),
                                 -std::sin(slant) * std::cos(azimuth), std::cos(slant));
  const glm::dvec3 tremble(trembleBy_[0].at(time), trembleBy_[1].at(time), trembleBy_[2].at(time));
  glm::dmat4 turn =
      glm::rotate(glm::dmat4(1), roll_.at(time) + trembleTurn_[2].at(time), {0, 0, 1});
  turn = glm::rotate(turn, trembleTurn_[1].at(time), {0, 1, 0});
  turn = glm::rotate(turn, trembleTurn_[0].at(time), {1, 0, 0});
  return turn * lookAt(target + distance * towardsCamera + tremble, target);
}

}  // namespace pleinair::hal::synthetic
