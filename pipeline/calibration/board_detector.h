#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "hal/image.h"
#include "pipeline/calibration/board.h"

namespace pleinair::calibration {

struct SightedCorner {
  int id = 0;  ///< index in Board::corners()
  glm::dvec2 px{0.0};
};

/// A board seen in an image. Pixels: centres at +0.5.
struct BoardSighting {
  std::vector<SightedCorner> corners;  ///< by rising id
  /// Width of the transition from black to white, in the worse of the board's two directions; about
  /// 1 px where the image is as sharp as pixels allow. See edgeWidth().
  double edgeWidthPx = 0.0;
};

/// Finds one board. One thread at a time.
class BoardDetector {
 public:
  virtual ~BoardDetector() = default;
  BoardDetector() = default;
  BoardDetector(const BoardDetector&) = delete;
  BoardDetector& operator=(const BoardDetector&) = delete;

  /// Returns nothing where the board, or enough of it (Board::minCorners()), is not visible. A
  /// checkerboard must be visible as a whole.
  virtual std::optional<BoardSighting> detect(const hal::PlaneView& luma, hal::FrameSize size) = 0;
};

/// The board outlives the detector.
std::unique_ptr<BoardDetector> makeBoardDetector(const Board& board);

// The kinds of BoardDetector. Precondition: the board is of that kind.

/// OpenCV's detector on a reduced image; corners are refined at full size.
std::unique_ptr<BoardDetector> makeCheckerboardDetector(const Board& board);
/// Uses tracking::TagDetector; corners are then refined like those of a checkerboard.
std::unique_ptr<BoardDetector> makeAprilGridDetector(const Board& board);

/// For an image without the board: finds another board that the user may have confused with it,
/// that is a checkerboard with one corner more or less per side (counting squares gives one too
/// many), or tags. "a checkerboard of 8x5 inner corners".
std::optional<std::string> otherBoardIn(const Board& board, const hal::PlaneView& luma,
                                        hal::FrameSize size);

}  // namespace pleinair::calibration
