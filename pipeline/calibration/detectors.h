#pragma once

#include <memory>

#include "pipeline/calibration/board_detector.h"

namespace pleinair::calibration {

// The kinds of BoardDetector. Preconditions: the board is of that kind.

/// OpenCV's, searched in a small picture and refined in the whole one.
std::unique_ptr<BoardDetector> makeCheckerboardDetector(const Board& board);
/// By tracking::TagDetector; corners are then refined as those of a checkerboard.
std::unique_ptr<BoardDetector> makeAprilGridDetector(const Board& board);

}  // namespace pleinair::calibration
