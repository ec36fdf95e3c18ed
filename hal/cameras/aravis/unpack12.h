#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace pleinair::hal::aravis {

/// Both unpack 12-bit samples to their upper 8 bits. Samples follow each other without a gap, two
/// in 3 bytes; a last odd one takes 2 bytes. Precondition: 2 · packed.size() ≥ 3 · samples.size().
///
/// The lower 4 bits are dropped and not rounded: rounding would make 255 of 4080 and of 4095 alike
/// and brighten the picture by half a level.

/// PFNC "12p": samples lie in rising bits of the bytes. Bytes: a₇…a₀ | b₃…b₀ a₁₁…a₈ | b₁₁…b₄.
void unpack12p(std::span<const std::uint8_t> packed, std::span<std::uint8_t> samples);

/// GigE Vision 1 "12Packed": the upper bits of both samples around their lower ones. Bytes:
/// a₁₁…a₄ | b₃…b₀ a₃…a₀ | b₁₁…b₄.
void unpack12Packed(std::span<const std::uint8_t> packed, std::span<std::uint8_t> samples);

}  // namespace pleinair::hal::aravis
