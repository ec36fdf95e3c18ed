#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "hal/image.h"
#include "pipeline/gpu/texture.h"

namespace pleinair::styles {

/// The brushes that strokes are painted with.
enum class Brush { kRound, kFlat, kDry, kKnife, kMarker, kPencil };
inline constexpr std::array kBrushes{Brush::kRound, Brush::kFlat,   Brush::kDry,
                                     Brush::kKnife, Brush::kMarker, Brush::kPencil};
/// The widths, in texels, in which each brush is made.
inline constexpr std::array kBrushTexels{8, 16, 32, 64};

inline constexpr int kBrushVariants = 4;  ///< of each, below each other, so that no stamp repeats

/// A brush's marks: RG8, LINEAR, kBrushVariants of them: how much paint is there, and how high it
/// lies. Each has `across` texels across the stroke and four times as many along it, which is for a
/// stroke of kBrushAspect; of others the middle is stretched. Made by arithmetic, always the same.
/// On the thread of a GL context. Precondition: `across` is above 0.
gpu::Texture makeBrush(Brush brush, int across);
inline constexpr double kBrushAspect = 4.0;

/// How often makeBrush() has been called in this process, for tests: it takes up to 20 ms, so that
/// none may be made while frames are painted. Any thread.
std::uint64_t brushesMade();

}  // namespace pleinair::styles
