#include "pipeline/calibration/board_detector.h"

#include <cstdlib>
#include <variant>

#include <fmt/format.h>

#include "pipeline/tracking/pose/tag_detector.h"

namespace pleinair::calibration {

std::unique_ptr<BoardDetector> makeBoardDetector(const Board& board) {
  const bool isCheckerboard = std::holds_alternative<Checkerboard>(board.kind());
  return isCheckerboard ? makeCheckerboardDetector(board) : makeAprilGridDetector(board);
}

namespace {

std::optional<std::string> otherCheckerboard(const Checkerboard& wanted, const hal::PlaneView& luma,
                                             hal::FrameSize size) {
  for (const int columns : {-1, 0, 1, -2}) {
    for (const int rows : {-1, 0, 1, -2}) {
      const Checkerboard other{.columns = wanted.columns + columns, .rows = wanted.rows + rows};
      if ((columns == 0 && rows == 0) || other.columns < 3 || other.rows < 3) continue;
      const Board board(other);
      if (!makeBoardDetector(board)->detect(luma, size)) continue;
      return fmt::format("a checkerboard of {}x{} inner corners", other.columns, other.rows);
    }
  }
  return std::nullopt;
}

std::optional<std::string> tagsIn(const hal::PlaneView& luma, hal::FrameSize size) {
  tracking::TagDetector detector({.decimation = 1.0});
  tracking::DetectionCounters counters;
  const auto tags = detector.detect(luma, size, counters);
  if (tags.empty()) return std::nullopt;
  const std::string ids = tags.size() == 1
                              ? fmt::format("tag {}", tags.front().id)
                              : fmt::format("tags {} to {}", tags.front().id, tags.back().id);
  return fmt::format("something with {} of {}", ids, tracking::kDefaultTagFamily);
}

}  // namespace

std::optional<std::string> otherBoardIn(const Board& board, const hal::PlaneView& luma,
                                        hal::FrameSize size) {
  const auto* checkerboard = std::get_if<Checkerboard>(&board.kind());
  if (checkerboard == nullptr) return tagsIn(luma, size);
  if (auto other = otherCheckerboard(*checkerboard, luma, size)) return other;
  return tagsIn(luma, size);
}

}  // namespace pleinair::calibration
