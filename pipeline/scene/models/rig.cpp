#include "pipeline/scene/models/rig.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

namespace pleinair::scene {

glm::dmat4 parentFromNode(const NodePlace& place) {
  const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), place.translation);
  return glm::scale(moved * glm::mat4_cast(place.rotation), place.scale);
}

bool isBounded(const glm::dmat4& matrix) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!(std::abs(matrix[column][row]) <= kMaxMatrixValue)) return false;  // rejects NaN too
    }
  }
  return true;
}

namespace {

/// The numbers of a key to read; cubic splines have tangents too.
enum class Part { kInTangent, kValue, kOutTangent };

std::span<const float> partOfKey(const Channel& channel, std::size_t key, Part part) {
  const bool isSpline = channel.interpolation == Interpolation::kCubicSpline;
  const std::size_t index = isSpline ? 3 * key + static_cast<std::size_t>(part) : key;
  return std::span(channel.values).subspan(index * channel.width, channel.width);
}

glm::dquat quaternionOf(std::span<const float> xyzw) {
  return glm::normalize(glm::dquat(static_cast<double>(xyzw[3]), static_cast<double>(xyzw[0]),
                                   static_cast<double>(xyzw[1]), static_cast<double>(xyzw[2])));
}

void store(const glm::dquat& rotation, std::span<double> xyzw) {
  xyzw[0] = rotation.x;
  xyzw[1] = rotation.y;
  xyzw[2] = rotation.z;
  xyzw[3] = rotation.w;
}

void holdKey(const Channel& channel, std::size_t key, std::span<double> value) {
  const std::span<const float> held = partOfKey(channel, key, Part::kValue);
  std::ranges::copy(held, value.begin());
  if (channel.property == AnimatedProperty::kRotation) store(quaternionOf(held), value);
}

/// `t`: position between `key` and the next one, 0 to 1.
void mixLinearly(const Channel& channel, std::size_t key, double t, std::span<double> value) {
  const std::span<const float> from = partOfKey(channel, key, Part::kValue);
  const std::span<const float> to = partOfKey(channel, key + 1, Part::kValue);
  if (channel.property == AnimatedProperty::kRotation) {
    // takes the shorter arc
    return store(glm::normalize(glm::slerp(quaternionOf(from), quaternionOf(to), t)), value);
  }
  for (std::size_t i = 0; i < value.size(); ++i) {
    value[i] = (1.0 - t) * static_cast<double>(from[i]) + t * static_cast<double>(to[i]);
  }
}

void mixBySpline(const Channel& channel, std::size_t key, double t, double keySeconds,
                 std::span<double> value) {
  const std::span<const float> from = partOfKey(channel, key, Part::kValue);
  const std::span<const float> out = partOfKey(channel, key, Part::kOutTangent);
  const std::span<const float> in = partOfKey(channel, key + 1, Part::kInTangent);
  const std::span<const float> to = partOfKey(channel, key + 1, Part::kValue);
  const double t2 = t * t;
  const double t3 = t2 * t;
  for (std::size_t i = 0; i < value.size(); ++i) {
    value[i] = (2.0 * t3 - 3.0 * t2 + 1.0) * static_cast<double>(from[i]) +
               keySeconds * (t3 - 2.0 * t2 + t) * static_cast<double>(out[i]) +
               (3.0 * t2 - 2.0 * t3) * static_cast<double>(to[i]) +
               keySeconds * (t3 - t2) * static_cast<double>(in[i]);
  }
  if (channel.property != AnimatedProperty::kRotation) return;
  const glm::dquat rotation(value[3], value[0], value[1], value[2]);
  if (glm::length(rotation) > 1e-9) {
    store(glm::normalize(rotation), value);
  } else {  // half way between opposite keys
    holdKey(channel, key, value);
  }
}

}  // namespace

void valueAt(const Channel& channel, double seconds, std::span<double> value) {
  assert(value.size() == channel.width && !channel.seconds.empty());
  const auto& keys = channel.seconds;
  const auto after = std::ranges::upper_bound(keys, seconds, {},
                                              [](float key) { return static_cast<double>(key); });
  if (after == keys.begin()) return holdKey(channel, 0, value);
  if (after == keys.end()) return holdKey(channel, keys.size() - 1, value);
  const auto key = static_cast<std::size_t>(after - keys.begin()) - 1;
  const auto start = static_cast<double>(keys[key]);
  const double keySeconds = static_cast<double>(keys[key + 1]) - start;
  const double t = (seconds - start) / keySeconds;
  switch (channel.interpolation) {
    case Interpolation::kStep:
      return holdKey(channel, key, value);
    case Interpolation::kLinear:
      return mixLinearly(channel, key, t, value);
    case Interpolation::kCubicSpline:
      return mixBySpline(channel, key, t, keySeconds, value);
  }
}

std::optional<ClipMoment> momentOf(const Rig& rig, const Playback& playback,
                                   hal::Duration elapsed) {
  if (!playback.clip) return std::nullopt;
  const double length = rig.clips[*playback.clip].seconds;
  const double run = playback.speed * hal::toSeconds(elapsed);
  ClipMoment moment{.clip = *playback.clip};
  if (playback.loops) {
    if (length > 0.0) {
      moment.seconds = std::clamp(run - length * std::floor(run / length), 0.0, length);
    }
  } else {
    moment.seconds = std::clamp(playback.speed < 0.0 ? length + run : run, 0.0, length);
  }
  return moment;
}

}  // namespace pleinair::scene
