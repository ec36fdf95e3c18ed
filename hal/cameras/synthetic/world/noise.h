#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

namespace pleinair::hal::synthetic {

/// Scrambles 64 bits (SplitMix64's finaliser): neighbouring inputs give unrelated outputs.
constexpr std::uint64_t mixBits(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15ULL;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

/// A pseudo-random number in [0, 1) for (seed, index), the same on every machine.
constexpr double unitRandom(std::uint64_t seed, std::uint64_t index) {
  return static_cast<double>(mixBits(mixBits(seed) ^ index) >> 11) * 0x1p-53;
}

/// Smooth noise in [0, 1] with features of size 1: a lattice of random values, interpolated.
float valueNoise(std::uint32_t seed, glm::vec2 point);

/// `octaves` of valueNoise, each with half the feature size and amplitude of the one before; in [0,
/// 1], mean 0.5.
float fractalNoise(std::uint32_t seed, glm::vec2 point, int octaves);

}  // namespace pleinair::hal::synthetic
