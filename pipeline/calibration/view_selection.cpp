#include "pipeline/calibration/view_selection.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

namespace pleinair::calibration {
namespace {

constexpr double kBlurShare = 1.5;  // relative to the sharpest board's edge width
// Corners of wider edges cannot be refined to a fraction of a pixel.
constexpr double kMaxEdgePx = 6.0;
/// A rolling shutter skews a moving board by its speed times the read-out time of about 20 ms.
constexpr double kMaxSpeed = 0.05;   // diagonals per second: 40 px at 640×480, a skew of 0.8 px
constexpr double kMinGain = 4.0;     // cells
constexpr double kSameView = 0.025;  // mean distance of the corners, in diagonals
// Views this different are taken even if they add no coverage.
constexpr double kDistinctView = 0.08;
// Diagonals: a rotation by 18° counts as much as another place.
constexpr double kSlopeWorth = 0.25;
constexpr double kSharperShare = 0.85;
constexpr std::size_t kSufficientViews = 15;
constexpr std::size_t kSharpestCount = 5;
constexpr hal::Duration kMaxPause = std::chrono::milliseconds(500);

}  // namespace

std::optional<double> cornerDistancePx(const BoardSighting& a, const BoardSighting& b) {
  constexpr int kMinShared = 4;
  double sum = 0.0;
  int count = 0;
  auto other = b.corners.begin();
  for (const SightedCorner& corner : a.corners) {
    while (other != b.corners.end() && other->id < corner.id) ++other;
    if (other == b.corners.end()) break;
    if (other->id != corner.id) continue;
    sum += glm::distance(corner.px, other->px);
    ++count;
  }
  if (count < kMinShared) return std::nullopt;
  return sum / count;
}

ViewSelector::ViewSelector(const Board& board, hal::FrameSize size, ViewSelectionOptions options)
    : board_(board),
      size_(size),
      options_(options),
      diagonalPx_(std::hypot(size.width, size.height)) {}

double ViewSelector::sharpestEdgePx() const {
  if (sharpest_.empty()) return 0.0;
  return sharpest_.size() < kSharpestCount ? sharpest_.front() : sharpest_.back();
}

double ViewSelector::widestEdgePx() const {
  return sharpest_.empty() ? kMaxEdgePx : std::min(kMaxEdgePx, kBlurShare * sharpestEdgePx());
}

bool ViewSelector::isComplete() const {
  return views_.size() >= kSufficientViews && coverage_.isComplete();
}

ViewOutcome ViewSelector::offer(std::uint64_t frame, hal::TimePoint time,
                                std::optional<BoardSighting> sighting) {
  ++counts_.pictures;
  if (!sighting) {
    last_.reset();
    return ViewOutcome::kNoBoard;
  }
  ++counts_.withBoard;
  const std::optional<double> speed = speedOf(time, *sighting);
  noteSharpness(sighting->edgeWidthPx);
  const ViewOutcome outcome = judge(frame, *sighting, speed);
  if (outcome == ViewOutcome::kBlurred) ++counts_.blurred;
  if (outcome == ViewOutcome::kMoving) ++counts_.moving;
  if (outcome == ViewOutcome::kNothingNew) ++counts_.nothingNew;
  last_ = std::move(sighting);
  lastTime_ = time;
  return outcome;
}

std::optional<double> ViewSelector::speedOf(hal::TimePoint time,
                                            const BoardSighting& sighting) const {
  if (!last_ || time - lastTime_ > kMaxPause) return std::nullopt;
  const double seconds = hal::toSeconds(time - lastTime_);
  const std::optional<double> distance = cornerDistancePx(*last_, sighting);
  if (!distance || !(seconds > 0.0)) return std::nullopt;
  return *distance / seconds;
}

void ViewSelector::noteSharpness(double edgeWidthPx) {
  sharpest_.insert(std::ranges::upper_bound(sharpest_, edgeWidthPx), edgeWidthPx);
  if (sharpest_.size() > kSharpestCount) sharpest_.pop_back();
  for (std::size_t i = views_.size(); i-- > 0;) {
    if (views_[i].sighting.edgeWidthPx > widestEdgePx()) drop(i);
  }
}

ViewOutcome ViewSelector::judge(std::uint64_t frame, const BoardSighting& sighting,
                                std::optional<double> speed) {
  if (sighting.edgeWidthPx > widestEdgePx()) return ViewOutcome::kBlurred;
  if (options_.isSequence &&
      !(speed.value_or(kMaxSpeed * diagonalPx_ + 1.0) <= kMaxSpeed * diagonalPx_)) {
    return ViewOutcome::kMoving;
  }
  SelectedView view{.frame = frame,
                    .sighting = sighting,
                    .traits = traitsOf(board_, sighting, size_),
                    .speed = options_.isSequence ? speed.value_or(0.0) : 0.0};

  double nearest = std::numeric_limits<double>::infinity();
  std::size_t nearestView = 0;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const double difference = differenceOf(views_[i], view);
    if (difference >= nearest) continue;
    nearest = difference;
    nearestView = i;
  }
  if (nearest < kSameView) {
    const SelectedView& same = views_[nearestView];
    if (sighting.edgeWidthPx > kSharperShare * same.sighting.edgeWidthPx) {
      return ViewOutcome::kNothingNew;
    }
    drop(nearestView);
    take(std::move(view));
    return ViewOutcome::kTaken;
  }
  const bool isWanted = coverage_.gain(view.traits) >= kMinGain;
  const bool isFull = views_.size() >= options_.maxViews;
  if (isFull && isWanted) {
    if (const auto spare = redundantView()) drop(*spare);
  } else if (!isWanted && nearest < kDistinctView) {
    return ViewOutcome::kNothingNew;
  }
  if (views_.size() >= options_.maxViews) return ViewOutcome::kNothingNew;
  take(std::move(view));
  return ViewOutcome::kTaken;
}

double ViewSelector::differenceOf(const SelectedView& a, const SelectedView& b) const {
  const std::optional<double> distance = cornerDistancePx(a.sighting, b.sighting);
  if (!distance) return std::numeric_limits<double>::infinity();
  return std::hypot(*distance / diagonalPx_,
                    kSlopeWorth * glm::distance(a.traits.slope, b.traits.slope));
}

void ViewSelector::take(SelectedView view) {
  coverage_.add(view.traits);
  views_.push_back(std::move(view));
}

void ViewSelector::drop(std::size_t index) {
  coverage_.remove(views_[index].traits);
  views_.erase(views_.begin() + static_cast<std::ptrdiff_t>(index));
}

std::optional<std::size_t> ViewSelector::redundantView() const {
  std::optional<std::size_t> widest;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    if (!coverage_.isRedundant(views_[i].traits)) continue;
    if (!widest || views_[i].sighting.edgeWidthPx > views_[*widest].sighting.edgeWidthPx) {
      widest = i;
    }
  }
  return widest;
}

std::vector<FitView> ViewSelector::fitViews() const {
  std::vector<FitView> views;
  for (const SelectedView& view : views_) {
    FitView points;
    for (const SightedCorner& corner : view.sighting.corners) {
      points.push_back({board_.corners()[static_cast<std::size_t>(corner.id)], corner.px});
    }
    views.push_back(std::move(points));
  }
  return views;
}

}  // namespace pleinair::calibration
