#include "pipeline/calibration/board_detector.h"

#include <variant>

namespace pleinair::calibration {

std::unique_ptr<BoardDetector> makeBoardDetector(const Board& board) {
  const bool isCheckerboard = std::holds_alternative<Checkerboard>(board.kind());
  return isCheckerboard ? makeCheckerboardDetector(board) : makeAprilGridDetector(board);
}

}  // namespace pleinair::calibration
