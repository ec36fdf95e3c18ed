#include "pipeline/calibration/coverage.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <glm/vec3.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace pleinair::calibration {
namespace {

constexpr double kMinSlope = 0.27;  // tan 15°
constexpr double kNearSize = 0.5;
constexpr double kGuessedFocal = 0.9;  // of the longer side; a field of view of 58°
constexpr double kTiltWorth = 3.0;     // as many cells
constexpr double kSizeWorth = 2.0;

constexpr std::size_t cellIndex(int column, int row) {
  return static_cast<std::size_t>(row * kCellColumns + column);
}

/// The first cell of each third.
constexpr std::array kColumnThirds{0, 3, 5, 8};
constexpr std::array kRowThirds{0, 2, 4, 6};

struct Region {
  int across = 0;
  int down = 0;
  std::string_view name;
};
/// Corners come first: users forget them, and lenses distort most there.
constexpr std::array<Region, 9> kRegions{{{0, 0, "the upper left corner"},
                                          {2, 0, "the upper right corner"},
                                          {2, 2, "the lower right corner"},
                                          {0, 2, "the lower left corner"},
                                          {0, 1, "the left side"},
                                          {2, 1, "the right side"},
                                          {1, 0, "the upper side"},
                                          {1, 2, "the lower side"},
                                          {1, 1, "the middle"}}};

constexpr std::array<std::string_view, kTilts> kTiltRequests{
    "tilt the board so that its left side is nearer to the camera",
    "tilt the board so that its right side is nearer to the camera",
    "tilt the board so that its upper side is nearer to the camera",
    "tilt the board so that its lower side is nearer to the camera"};

/// A plane n·p = d has the distance Z = d / n·(x, y, 1) along the ray (x, y, 1). The last row of
/// the homography from rays to the board is n up to scale.
glm::dvec2 slopeOf(const Board& board, const BoardSighting& sighting, hal::FrameSize size) {
  std::vector<cv::Point2d> onBoard;
  std::vector<cv::Point2d> onPlane;
  const double focal = kGuessedFocal * std::max(size.width, size.height);
  for (const SightedCorner& corner : sighting.corners) {
    const glm::dvec3& at = board.corners()[static_cast<std::size_t>(corner.id)];
    onBoard.emplace_back(at.x, at.y);
    onPlane.emplace_back((corner.px.x - size.width / 2.0) / focal,
                         (corner.px.y - size.height / 2.0) / focal);
  }
  const cv::Mat found = cv::findHomography(onPlane, onBoard);
  if (found.empty()) return glm::dvec2(0.0);
  const cv::Matx33d h(found);
  const double middle = h(2, 2);
  if (middle == 0.0) return glm::dvec2(0.0);
  return {-h(2, 0) / middle, -h(2, 1) / middle};
}

}  // namespace

bool ViewTraits::has(Tilt tilt) const {
  switch (tilt) {
    case Tilt::kLeftNearer:
      return slope.x > kMinSlope;
    case Tilt::kRightNearer:
      return slope.x < -kMinSlope;
    case Tilt::kTopNearer:
      return slope.y > kMinSlope;
    case Tilt::kBottomNearer:
      break;
  }
  return slope.y < -kMinSlope;
}

bool ViewTraits::isNear() const {
  return size >= kNearSize;
}

ViewTraits traitsOf(const Board& board, const BoardSighting& sighting, hal::FrameSize size) {
  ViewTraits traits;
  std::vector<cv::Point2f> points;
  for (const SightedCorner& corner : sighting.corners) {
    const int column =
        std::clamp(static_cast<int>(corner.px.x * kCellColumns / size.width), 0, kCellColumns - 1);
    const int row =
        std::clamp(static_cast<int>(corner.px.y * kCellRows / size.height), 0, kCellRows - 1);
    traits.cells.set(cellIndex(column, row));
    points.emplace_back(static_cast<float>(corner.px.x), static_cast<float>(corner.px.y));
  }
  std::vector<cv::Point2f> hull;
  cv::convexHull(points, hull);
  traits.size = std::sqrt(cv::contourArea(hull) / static_cast<double>(size.pixels()));
  traits.slope = slopeOf(board, sighting, size);
  return traits;
}

void Coverage::count(const ViewTraits& traits, int by) {
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    if (traits.cells.test(cell)) cells_.at(cell) += by;
  }
  for (std::size_t tilt = 0; tilt < kTilts; ++tilt) {
    if (traits.has(static_cast<Tilt>(tilt))) tilts_.at(tilt) += by;
  }
  (traits.isNear() ? near_ : far_) += by;
}

double Coverage::gain(const ViewTraits& traits) const {
  double gain = 0.0;
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    if (traits.cells.test(cell) && cells_.at(cell) < kWantedPerCell) gain += 1.0;
  }
  for (std::size_t tilt = 0; tilt < kTilts; ++tilt) {
    if (traits.has(static_cast<Tilt>(tilt)) && tilts_.at(tilt) < kWantedPerTilt) {
      gain += kTiltWorth;
    }
  }
  const bool isSizeWanted = traits.isNear() ? near_ < kWantedNear : far_ < kWantedFar;
  return gain + (isSizeWanted ? kSizeWorth : 0.0);
}

bool Coverage::isRedundant(const ViewTraits& traits) const {
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    if (traits.cells.test(cell) && cells_.at(cell) <= kWantedPerCell) return false;
  }
  for (std::size_t tilt = 0; tilt < kTilts; ++tilt) {
    if (traits.has(static_cast<Tilt>(tilt)) && tilts_.at(tilt) <= kWantedPerTilt) return false;
  }
  return traits.isNear() ? near_ > kWantedNear : far_ > kWantedFar;
}

int Coverage::viewsInCell(int column, int row) const {
  return cells_.at(cellIndex(column, row));
}

double Coverage::coveredShare() const {
  const auto covered = std::ranges::count_if(cells_, [](int views) { return views > 0; });
  return static_cast<double>(covered) / static_cast<double>(kCells);
}

std::vector<std::string> Coverage::uncoveredRegions() const {
  constexpr double kMinShare = 1.0 / 3.0;  // of a region's cells
  std::vector<std::string> regions;
  for (const Region& region : kRegions) {
    int covered = 0;
    int all = 0;
    const auto at = [](const auto& thirds, int third) {
      return thirds.at(static_cast<std::size_t>(third));
    };
    for (int row = at(kRowThirds, region.down); row < at(kRowThirds, region.down + 1); ++row) {
      for (int column = at(kColumnThirds, region.across);
           column < at(kColumnThirds, region.across + 1); ++column) {
        ++all;
        if (viewsInCell(column, row) > 0) ++covered;
      }
    }
    if (covered < kMinShare * all) regions.emplace_back(region.name);
  }
  return regions;
}

std::optional<std::string> Coverage::missingViews() const {
  for (std::size_t tilt = 0; tilt < kTilts; ++tilt) {
    if (tilts_.at(tilt) < kWantedPerTilt) return std::string(kTiltRequests.at(tilt));
  }
  if (near_ < kWantedNear) return "hold the board nearer: let it fill the picture";
  if (far_ < kWantedFar) return "hold the board further away";
  const std::vector<std::string> regions = uncoveredRegions();
  if (!regions.empty()) return "bring the board to " + regions.front();
  return std::nullopt;
}

}  // namespace pleinair::calibration
