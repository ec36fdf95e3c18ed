#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/gpu/texture.h"

namespace pleinair::gpu {

/// The pixels of an RGBA8 texture, row by row, 4 bytes each. Waits for the GPU; the thread of the
/// context.
std::vector<std::uint8_t> pixelsOf(const Texture& texture);
/// How what the GPU has read of a camera's memory differs from what the processor has.
std::string differenceText(std::span<const std::uint8_t> seen, std::span<const std::uint8_t> right);

}  // namespace pleinair::gpu
