#include <algorithm>
#include <array>
#include <cstddef>
#include <variant>

#include <glm/geometric.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/calibration/board_detector.h"
#include "pipeline/calibration/board_sighting.h"
#include "pipeline/tracking/pose/tag_detector.h"

namespace pleinair::calibration {
namespace {

using tracking::TagDetection;

constexpr double kWindowShare = 0.45;  // of the gap, which the black corner squares fill
constexpr double kSofteningPx = 0.0;   // none: a corner's neighbour is too close
constexpr double kMinWindowPx = 2.0;
constexpr double kMaxWindowPx = 8.0;

struct GridTag {
  int index = 0;  ///< relative to the grid's first tag
  TagDetection seen;
};

double edgePx(const TagDetection& tag) {
  double length = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    length += glm::distance(tag.corners[i], tag.corners[(i + 1) % 4]) / 4.0;
  }
  return length;
}

glm::dvec2 centreOf(const TagDetection& tag) {
  return (tag.corners[0] + tag.corners[1] + tag.corners[2] + tag.corners[3]) / 4.0;
}

/// Tags give the position of the grid only. Their rotation on the paper depends on the program that
/// drew the grid, so a corner gets its id from its position.
class AprilGridDetector final : public BoardDetector {
 public:
  explicit AprilGridDetector(const Board& board)
      : board_(board), grid_(std::get<AprilGrid>(board.kind())) {}

  std::optional<BoardSighting> detect(const hal::PlaneView& luma, hal::FrameSize size) override {
    const std::vector<GridTag> tags = findTags(luma, size);
    std::vector<SightedCorner> corners = placedCorners(tags);
    if (corners.empty()) return std::nullopt;
    double edge = edgePx(tags.front().seen);
    for (const GridTag& tag : tags) edge = std::min(edge, edgePx(tag.seen));
    const double window =
        std::clamp(kWindowShare * grid_.spacing * edge, kMinWindowPx, kMaxWindowPx);
    refineCorners(luma, size, static_cast<int>(window), kSofteningPx, corners);
    std::ranges::sort(corners, {}, &SightedCorner::id);
    if (static_cast<int>(corners.size()) < board_.minCorners()) return std::nullopt;
    const std::optional<double> width = edgeWidth(luma, size, board_, corners);
    if (!width) return std::nullopt;
    return BoardSighting{.corners = std::move(corners), .edgeWidthPx = *width};
  }

 private:
  /// A tag touches the black squares at its corners. Where the lens or the pixels blur the contact,
  /// they merge into one shape that is no tag. So missing tags are searched for in images in which
  /// white was dilated by one and by two pixels.
  std::vector<GridTag> findTags(const hal::PlaneView& luma, hal::FrameSize size) {
    std::vector<GridTag> tags;
    addTags(luma, size, tags);
    const cv::Mat picture(size.height, size.width, CV_8UC1,
                          const_cast<std::uint8_t*>(luma.bytes.data()), luma.strideBytes);
    for (const int grown : {1, 2}) {
      if (tags.size() == static_cast<std::size_t>(grid_.columns * grid_.rows)) break;
      const int side = 2 * grown + 1;
      cv::dilate(picture, grown_, cv::Mat::ones(side, side, CV_8UC1));
      addTags({.bytes = {grown_.data, grown_.total()}, .strideBytes = grown_.step}, size, tags);
    }
    return tags;
  }

  /// Adds the tags of the grid that are still missing.
  void addTags(const hal::PlaneView& luma, hal::FrameSize size, std::vector<GridTag>& tags) {
    tracking::DetectionCounters counters;
    for (const TagDetection& tag : detector_.detect(luma, size, counters)) {
      const int index = tag.id - grid_.firstId;
      const bool isOfGrid = index >= 0 && index < grid_.columns * grid_.rows;
      if (isOfGrid && std::ranges::find(tags, index, &GridTag::index) == tags.end()) {
        tags.push_back({index, tag});
      }
    }
  }

  /// Index on the board of the first of a tag's four corners.
  static std::size_t firstCorner(const GridTag& tag) {
    return static_cast<std::size_t>(tag.index) * 4;
  }

  std::vector<SightedCorner> placedCorners(const std::vector<GridTag>& tags) const {
    if (tags.size() * 4 < static_cast<std::size_t>(board_.minCorners())) return {};
    std::vector<cv::Point2d> onBoard;
    std::vector<cv::Point2d> inPicture;
    for (const GridTag& tag : tags) {
      const std::size_t first = firstCorner(tag);
      const glm::dvec3 centre = (board_.corners()[first] + board_.corners()[first + 2]) / 2.0;
      const glm::dvec2 px = centreOf(tag.seen);
      onBoard.emplace_back(centre.x, centre.y);
      inPicture.emplace_back(px.x, px.y);
    }
    const cv::Mat found = cv::findHomography(onBoard, inPicture);
    if (found.empty()) return {};  // collinear
    const cv::Matx33d pictureFromBoard(found);
    std::vector<SightedCorner> corners;
    std::size_t inPlace = 0;
    for (const GridTag& tag : tags) inPlace += addCorners(tag, pictureFromBoard, corners) ? 1 : 0;
    // Tags of another grid have these ids at other positions.
    constexpr double kMinInPlaceShare = 0.75;
    if (static_cast<double>(inPlace) < kMinInPlaceShare * static_cast<double>(tags.size()))
      return {};
    return corners;
  }

  /// Assigns each of the tag's four corners to the nearest detected one. Positions are compared
  /// relative to the tag's centre, since a lens shifts a tag more than it deforms it. Returns false
  /// where the tag is not at its position in the grid.
  bool addCorners(const GridTag& tag, const cv::Matx33d& pictureFromBoard,
                  std::vector<SightedCorner>& corners) const {
    const std::size_t first = firstCorner(tag);
    const auto project = [&](const glm::dvec3& point) {
      const cv::Vec3d h = pictureFromBoard * cv::Vec3d(point.x, point.y, 1.0);
      return glm::dvec2(h[0] / h[2], h[1] / h[2]);
    };
    const glm::dvec2 shift =
        centreOf(tag.seen) - project((board_.corners()[first] + board_.corners()[first + 2]) / 2.0);
    if (glm::length(shift) > edgePx(tag.seen)) return false;
    std::array<bool, 4> isTaken{};
    std::array<SightedCorner, 4> four{};
    for (std::size_t i = 0; i < 4; ++i) {
      const glm::dvec2 expected = project(board_.corners()[first + i]) + shift;
      std::size_t nearest = 0;
      for (std::size_t j = 1; j < 4; ++j) {
        if (glm::distance(tag.seen.corners[j], expected) <
            glm::distance(tag.seen.corners[nearest], expected)) {
          nearest = j;
        }
      }
      isTaken[nearest] = true;
      four[i] = {static_cast<int>(first + i), tag.seen.corners[nearest]};
    }
    if (std::ranges::count(isTaken, true) < 4) return false;
    corners.insert(corners.end(), four.begin(), four.end());
    return true;
  }

  const Board& board_;
  AprilGrid grid_;
  cv::Mat grown_;
  // Not reduced: the squares between the tags would merge with them.
  tracking::TagDetector detector_{{.decimation = 1.0}};
};

}  // namespace

std::unique_ptr<BoardDetector> makeAprilGridDetector(const Board& board) {
  return std::make_unique<AprilGridDetector>(board);
}

}  // namespace pleinair::calibration
