#pragma once

#include <array>
#include <string_view>

#include "hal/image.h"
#include "pipeline/gpu/texture.h"

namespace pleinair::styles {

/// The brushes that strokes are painted with.
enum class Brush { kRound, kFlat, kDry, kKnife, kMarker, kPencil };

inline constexpr int kBrushVariants = 4;  ///< of each, below each other, so that no stamp repeats
inline constexpr hal::FrameSize kBrushSize{256, 64};  ///< of a variant: along and across a stroke

/// A brush's marks: RG8 of kBrushSize, kBrushVariants times: how much paint is there, and how high
/// it lies. Made by arithmetic, always the same.
gpu::Texture makeBrush(Brush brush);

}  // namespace pleinair::styles
