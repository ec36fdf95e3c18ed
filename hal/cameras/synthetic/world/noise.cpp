#include "hal/cameras/synthetic/world/noise.h"

namespace pleinair::hal::synthetic {
namespace {

float latticeValue(std::uint32_t seed, std::int32_t x, std::int32_t y) {
  std::uint32_t hash = seed ^ (static_cast<std::uint32_t>(x) * 0x8da6b343U) ^
                       (static_cast<std::uint32_t>(y) * 0xd8163841U);
  hash = (hash ^ (hash >> 16)) * 0x7feb352dU;
  hash = (hash ^ (hash >> 15)) * 0x846ca68bU;
  hash ^= hash >> 16;
  return static_cast<float>(hash >> 8) * 0x1p-24F;
}

/// Floor of a value that fits into 32 bits; std::floor is a function call without SSE4.1.
std::int32_t floorOf(float value) {
  const auto towardsZero = static_cast<std::int32_t>(value);
  return towardsZero - (value < static_cast<float>(towardsZero) ? 1 : 0);
}

float ease(float t) {
  return t * t * (3 - 2 * t);
}
float mix(float from, float to, float t) {
  return from + (to - from) * t;
}

}  // namespace

float valueNoise(std::uint32_t seed, glm::vec2 point) {
  const std::int32_t x = floorOf(point.x);
  const std::int32_t y = floorOf(point.y);
  const float tx = ease(point.x - static_cast<float>(x));
  const float ty = ease(point.y - static_cast<float>(y));
  const float top = mix(latticeValue(seed, x, y), latticeValue(seed, x + 1, y), tx);
  const float bottom = mix(latticeValue(seed, x, y + 1), latticeValue(seed, x + 1, y + 1), tx);
  return mix(top, bottom, ty);
}

float fractalNoise(std::uint32_t seed, glm::vec2 point, int octaves) {
  float sum = 0;
  float weight = 1;
  float weights = 0;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += weight * valueNoise(seed + static_cast<std::uint32_t>(octave) * 0x9e3779b9U, point);
    weights += weight;
    weight *= 0.5F;
    point *= 2.03F;  // not exactly 2, so that the lattices do not line up
  }
  return sum / weights;
}

}  // namespace pleinair::hal::synthetic
