#include "tests/support/textured_plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>

#include <glm/vec3.hpp>

namespace pleinair::support {
namespace {

/// The random value of a lattice point, in [-1, 1].
double latticeValue(int x, int y, unsigned seed) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9E3779B1U +
                    static_cast<std::uint32_t>(y) * 0x85EBCA77U + seed * 0xC2B2AE3DU;
  h = (h ^ (h >> 15)) * 0x2C1B3C6DU;
  h = (h ^ (h >> 12)) * 0x297A2D39U;
  h ^= h >> 15;
  return static_cast<double>(h) / 2147483647.5 - 1.0;
}

/// A weight that is twice continuously differentiable between lattice points.
double smooth(double t) {
  return t * t * t * (t * (6.0 * t - 15.0) + 10.0);
}

double noiseAt(const glm::dvec2& p, unsigned seed) {
  const double fx = std::floor(p.x);
  const double fy = std::floor(p.y);
  const int x = static_cast<int>(fx);
  const int y = static_cast<int>(fy);
  const double u = smooth(p.x - fx);
  const double v = smooth(p.y - fy);
  const double top = (1.0 - u) * latticeValue(x, y, seed) + u * latticeValue(x + 1, y, seed);
  const double low =
      (1.0 - u) * latticeValue(x, y + 1, seed) + u * latticeValue(x + 1, y + 1, seed);
  return (1.0 - v) * top + v * low;
}

double levelAt(const WallView& view, int x, int y) {
  const glm::dvec3 at = view.wallFromFrame * glm::dvec3(x + 0.5, y + 0.5, 1.0);
  return view.brightness + view.contrast * wallAt(glm::dvec2(at) / at.z, view.wallSeed);
}

void render(hal::Image& image, const WallView& view, const glm::ivec2& from, const glm::ivec2& to) {
  std::minstd_rand random(view.noiseSeed * 7919U + 1U);
  std::normal_distribution<double> noise(0.0, 1.0);
  for (int y = from.y; y < to.y; ++y) {
    const auto row = image.row(0, y);
    for (int x = from.x; x < to.x; ++x) {
      double level = levelAt(view, x, y);
      if (view.noiseSigma > 0.0) level += view.noiseSigma * noise(random);
      row[static_cast<std::size_t>(x)] =
          static_cast<std::uint8_t>(std::clamp(std::lround(level), 0L, 255L));
    }
  }
}

}  // namespace

double wallAt(const glm::dvec2& place, unsigned seed) {
  struct Octave {
    double size;
    double levels;
  };
  constexpr std::array<Octave, 4> kOctaves{{{61.0, 50.0}, {23.0, 32.0}, {11.0, 22.0}, {5.3, 10.0}}};
  double level = 120.0;
  unsigned octave = 0;
  for (const auto& [size, levels] : kOctaves) {
    level += levels * noiseAt(place / size, seed * 31U + octave++);
  }
  return level;
}

hal::Image renderWall(const WallView& view) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kGrey8, .size = view.size});
  render(image, view, {0, 0}, {view.size.width, view.size.height});
  return image;
}

void overlayWall(hal::Image& image, const WallView& view, const glm::ivec2& from,
                 const glm::ivec2& to) {
  const glm::ivec2 end(image.size().width, image.size().height);
  render(image, view, glm::max(from, glm::ivec2(0)), glm::min(to, end));
}

glm::dmat3 currentFromPrevious(const PlaneStep& step, hal::FrameSize size) {
  const glm::dvec2 middle(size.width / 2.0, size.height / 2.0);
  const double c = step.zoom * std::cos(step.turn);
  const double s = step.zoom * std::sin(step.turn);
  const glm::dmat3 toMiddle(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, -middle.x, -middle.y, 1.0);
  const glm::dmat3 moved(c, s, step.bend.x, -s, c, step.bend.y, step.shift.x, step.shift.y, 1.0);
  const glm::dmat3 back(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, middle.x, middle.y, 1.0);
  return back * moved * toMiddle;
}

}  // namespace pleinair::support
