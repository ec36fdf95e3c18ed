#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "hal/image.h"
#include "pipeline/calibration/board.h"

namespace pleinair::calibration {

struct SightedCorner {
  int id = 0;  ///< of Board::corners()
  glm::dvec2 px{0.0};
};

/// A board in a picture. Pixels: centres at +0.5.
struct BoardSighting {
  std::vector<SightedCorner> corners;  ///< by rising id
  /// How far black takes to become white, across the worse of the board's two directions; about 1
  /// px where it is as sharp as pixels can be. See edgeWidth().
  double edgeWidthPx = 0.0;
};

/// Finds one board. One thread at a time.
class BoardDetector {
 public:
  virtual ~BoardDetector() = default;
  BoardDetector() = default;
  BoardDetector(const BoardDetector&) = delete;
  BoardDetector& operator=(const BoardDetector&) = delete;

  /// Nothing where the board, or enough of it (Board::fewestCorners()), is not seen. A checkerboard
  /// has to be seen whole.
  virtual std::optional<BoardSighting> detect(const hal::PlaneView& luma, hal::FrameSize size) = 0;
};

/// The board outlives the detector.
std::unique_ptr<BoardDetector> makeBoardDetector(const Board& board);

// The kinds of BoardDetector. Preconditions: the board is of that kind.

/// OpenCV's, searched in a small picture and refined in the whole one.
std::unique_ptr<BoardDetector> makeCheckerboardDetector(const Board& board);
/// By tracking::TagDetector; corners are then refined as those of a checkerboard.
std::unique_ptr<BoardDetector> makeAprilGridDetector(const Board& board);

}  // namespace pleinair::calibration
