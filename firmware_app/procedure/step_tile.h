#pragma once

#include <span>
#include <string>

#include "hal/image.h"
#include "pipeline/procedure/procedure.h"

namespace pleinair::app {

/// The rows of illustrations on a tile.
inline constexpr int kIllustrationRows = 96;

/// A picture with a step's text below: number and title, warnings, text, tools, torque, the check
/// with its limits, and where each outcome leads; and below the text the illustrations, side by
/// side, RGB8 of kIllustrationRows. RGB8, as wide as the picture, `textRows` px higher; what does
/// not fit is cut.
hal::Image stepTile(const procedure::Procedure& procedure, std::size_t step,
                    const std::string& language, const hal::Image& picture,
                    std::span<const hal::Image> illustrations, int textRows);

/// The rows that the step's text and its illustrations, if any, need below a picture of this width.
int stepTextRows(const procedure::Procedure& procedure, std::size_t step,
                 const std::string& language, int width);

}  // namespace pleinair::app
