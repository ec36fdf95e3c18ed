#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <variant>

#include <glm/geometric.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/calibration/board_detector.h"
#include "pipeline/calibration/board_sighting.h"

namespace pleinair::calibration {
namespace {

/// Images are reduced to at most this side for the search; corners are refined at full size.
constexpr int kSearchedSidePx = 720;
constexpr double kWindowShare =
    0.35;  // part of the distance to the next corner, so that the window does not reach it
constexpr double kSofteningPx = 1.0;
constexpr double kMinWindowPx = 2.0;
constexpr double kMaxWindowPx = 10.0;

class CheckerboardDetector final : public BoardDetector {
 public:
  explicit CheckerboardDetector(const Board& board)
      : board_(board), pattern_(std::get<Checkerboard>(board.kind())) {}

  std::optional<BoardSighting> detect(const hal::PlaneView& luma, hal::FrameSize size) override {
    std::vector<SightedCorner> corners = search(luma, size);
    if (corners.empty()) return std::nullopt;
    const double window =
        std::clamp(kWindowShare * shortestStep(corners), kMinWindowPx, kMaxWindowPx);
    refineCorners(luma, size, static_cast<int>(window), kSofteningPx, corners);
    if (corners.size() != board_.corners().size()) return std::nullopt;
    const std::optional<double> width = edgeWidth(luma, size, board_, corners);
    if (!width) return std::nullopt;
    return BoardSighting{.corners = std::move(corners), .edgeWidthPx = *width};
  }

 private:
  std::vector<SightedCorner> search(const hal::PlaneView& luma, hal::FrameSize size) {
    const cv::Mat whole(size.height, size.width, CV_8UC1,
                        const_cast<std::uint8_t*>(luma.bytes.data()), luma.strideBytes);
    const double scale =
        std::min(1.0, kSearchedSidePx / static_cast<double>(std::max(size.width, size.height)));
    cv::Mat searched = whole;
    if (scale < 1.0) cv::resize(whole, searched, {}, scale, scale, cv::INTER_AREA);
    const std::vector<cv::Point2f> found = find(searched);
    if (found.empty()) return {};
    const glm::dvec2 back(static_cast<double>(size.width) / searched.cols,
                          static_cast<double>(size.height) / searched.rows);
    std::vector<SightedCorner> corners;
    for (std::size_t i = 0; i < found.size(); ++i) {
      corners.push_back(
          {.id = static_cast<int>(i), .px = (glm::dvec2(found[i].x, found[i].y) + 0.5) * back});
    }
    return corners;
  }

  /// The quick search finds most boards in milliseconds; the thorough one finds those that a lens
  /// deforms or that are tilted, in a tenth of a second. The quick search runs without
  /// equalisation: on images without a board, equalisation turns noise into squares and takes many
  /// seconds.
  std::vector<cv::Point2f> find(const cv::Mat& searched) const {
    const cv::Size corners(pattern_.columns, pattern_.rows);
    std::vector<cv::Point2f> found;
    constexpr int kQuick = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_FAST_CHECK;
    if (cv::findChessboardCorners(searched, corners, found, kQuick)) return found;
    if (!cv::checkChessboard(searched, corners)) return {};
    if (cv::findChessboardCornersSB(searched, corners, found)) return found;
    return {};
  }

  double shortestStep(const std::vector<SightedCorner>& corners) const {
    double shortest = std::numeric_limits<double>::infinity();
    for (const BoardEdge& edge : board_.edges()) {
      const glm::dvec2 step = corners[static_cast<std::size_t>(edge.to)].px -
                              corners[static_cast<std::size_t>(edge.from)].px;
      shortest = std::min(shortest, glm::length(step));
    }
    return shortest;
  }

  const Board& board_;
  Checkerboard pattern_;
};

}  // namespace

std::unique_ptr<BoardDetector> makeCheckerboardDetector(const Board& board) {
  return std::make_unique<CheckerboardDetector>(board);
}

}  // namespace pleinair::calibration
