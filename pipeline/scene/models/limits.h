#pragma once

#include <cstdint>

namespace pleinair::scene {

// ArFrame::ids packs an object (upper bits) and a triangle of it (lower bits) in 31 bits.

inline constexpr std::uint32_t kTriangleBits = 22;
/// The number that stands for real things.
inline constexpr std::uint32_t kRealObject = 1U << (31U - kTriangleBits);
/// The last number below kRealObject stands for movers, where strokes are clipped.
inline constexpr std::uint32_t kMaxObjects = kRealObject - 2U;
inline constexpr std::uint32_t kMaxTriangles = 1U << kTriangleBits;

}  // namespace pleinair::scene
