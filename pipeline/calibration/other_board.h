#pragma once

#include <optional>
#include <string>

#include "hal/image.h"
#include "pipeline/calibration/board.h"

namespace pleinair::calibration {

/// For an image without the board: finds another board that the user may have confused with it,
/// that is a checkerboard with one corner more or less per side (counting squares gives one too
/// many), or tags. "a checkerboard of 8x5 inner corners".
std::optional<std::string> otherBoardIn(const Board& board, const hal::PlaneView& luma,
                                        hal::FrameSize size);

}  // namespace pleinair::calibration
