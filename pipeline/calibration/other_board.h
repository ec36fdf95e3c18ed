#pragma once

#include <optional>
#include <string>

#include "hal/image.h"
#include "pipeline/calibration/board.h"

namespace pleinair::calibration {

/// Where a board is not in a picture, what is there that it might have been taken for:
/// checkerboards of one corner more or less a side (who counts squares gives one too many), or
/// tags. "a checkerboard of 8x5 inner corners".
std::optional<std::string> otherBoardIn(const Board& board, const hal::PlaneView& luma,
                                        hal::FrameSize size);

}  // namespace pleinair::calibration
