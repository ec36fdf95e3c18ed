#include "pipeline/measure/anchor_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/measure/input/picture.h"
#include "pipeline/measure/output_measures.h"

namespace pleinair::measure {
namespace {

using marks::Anchor;

constexpr int kCellPixels = 8;

}  // namespace

bool AnchorMeasures::isInner(const Anchor& anchor) const {
  return innerRect(frame_).contains(cv::Point(imagePoint(anchor)));
}

void AnchorMeasures::add(std::span<const Anchor> anchors, const MotionMap* sinceLast,
                         const MotionMap* sinceLong, const cv::Mat1b* ignored) {
  if (!past_.empty() && past_.back().size() == anchors.size()) {
    AnchorFrame frame = compare(anchors, ignored);
    frame.drift = driftSince(past_.back(), anchors, sinceLast);
    if (past_.size() >= kLongLag) {
      frame.longDrift = driftSince(past_[past_.size() - kLongLag], anchors, sinceLong);
    }
    frames_.push_back(frame);
  }
  countCells(anchors);
  past_.emplace_back(anchors.begin(), anchors.end());
  if (past_.size() > kLongLag) past_.pop_front();
}

AnchorFrame AnchorMeasures::compare(std::span<const Anchor> anchors,
                                    const cv::Mat1b* ignored) const {
  AnchorFrame frame;
  const auto counts = [&](const Anchor& anchor) {
    const cv::Point at(imagePoint(anchor));
    return ignored == nullptr || !cv::Rect({}, frame_).contains(at) || (*ignored)(at) == 0;
  };
  for (std::size_t slot = 0; slot < anchors.size(); ++slot) {
    const Anchor& previous = past_.back()[slot];
    const Anchor& current = anchors[slot];
    const bool same = isSame(previous, current);
    const bool isBirth = current.isAlive() && !same && counts(current);
    const bool isDeath = previous.isStaying() &&
                         !(same && (current.isStaying() || current.isCovered())) &&
                         counts(previous);
    frame.alive += current.isAlive() ? 1 : 0;
    frame.births += isBirth ? 1 : 0;
    frame.deaths += isDeath ? 1 : 0;
    frame.inner += current.isAlive() && isInner(current) ? 1 : 0;
    frame.innerBirths += isBirth && isInner(current) ? 1 : 0;
    frame.innerDeaths += isDeath && isInner(previous) ? 1 : 0;
    frame.moved += same && current.px != previous.px ? 1 : 0;
  }
  return frame;
}

std::optional<Drift> AnchorMeasures::driftSince(std::span<const Anchor> previous,
                                                std::span<const Anchor> current,
                                                const MotionMap* motion) const {
  if (motion == nullptr || previous.size() != current.size()) return std::nullopt;
  std::vector<float> distances;
  for (std::size_t slot = 0; slot < current.size(); ++slot) {
    const bool isCompared = isSame(previous[slot], current[slot]) && previous[slot].isStaying() &&
                            current[slot].isStaying() && isInner(current[slot]);
    if (!isCompared) continue;
    const auto truth = displacementAt(*motion, imagePoint(previous[slot]));
    if (!truth) continue;
    const cv::Point2f error = imagePoint(current[slot]) - imagePoint(previous[slot]) - *truth;
    distances.push_back(std::hypot(error.x, error.y));
  }
  return driftOf(std::move(distances));
}

void AnchorMeasures::countCells(std::span<const Anchor> anchors) {
  const int columns = frame_.width / kCellPixels;
  const int rows = frame_.height / kCellPixels;
  cv::Mat1i counts(rows, columns, 0);
  bool any = false;
  for (const Anchor& anchor : anchors) {
    if (!anchor.isStaying()) continue;
    const int column = static_cast<int>(std::floor(anchor.px.x / kCellPixels));
    const int row = static_cast<int>(std::floor(anchor.px.y / kCellPixels));
    if (column < 0 || row < 0 || column >= columns || row >= rows) continue;
    ++counts(row, column);
    any = true;
  }
  if (!any) return;
  for (const int count : counts) {
    perCell_ += {static_cast<double>(count), 1.0};
    squarePerCell_ += {static_cast<double>(count) * count, 1.0};
    emptyCells_ += {count == 0 ? 1.0 : 0.0, 1.0};
  }
}

std::optional<AnchorSummary> AnchorMeasures::total(std::size_t first) const {
  if (!perCell_.value() || first >= frames_.size()) return std::nullopt;
  AnchorSummary all{.frames = frames_.size() - first};
  MeanDrift drift, longDrift;
  double inner = 0;
  for (const AnchorFrame& frame : std::span(frames_).subspan(first)) {
    all.alive += static_cast<double>(frame.alive);
    all.births += static_cast<double>(frame.births);
    all.deaths += static_cast<double>(frame.deaths);
    all.innerBirths += static_cast<double>(frame.innerBirths);
    all.innerDeaths += static_cast<double>(frame.innerDeaths);
    all.moved += static_cast<double>(frame.moved);
    inner += static_cast<double>(frame.inner);
    drift.add(frame.drift);
    longDrift.add(frame.longDrift);
  }
  if (inner > 0) {
    all.innerTurnoverPercent = 100.0 * (all.innerBirths + all.innerDeaths) / inner;
    const double share = std::min(all.innerDeaths / inner, 0.999);
    const double halfLife =
        share > 0 ? std::log(0.5) / std::log(1.0 - share) : std::numeric_limits<double>::infinity();
    if (halfLife <= static_cast<double>(all.frames)) all.halfLifeFrames = halfLife;
  }
  for (double* sum :
       {&all.alive, &all.births, &all.deaths, &all.innerBirths, &all.innerDeaths, &all.moved}) {
    *sum /= static_cast<double>(all.frames);
  }
  all.drift = drift.value();
  all.longDrift = longDrift.value();
  all.perCell = *perCell_.value();
  all.spreadPerCell =
      std::sqrt(std::max(0.0, squarePerCell_.value().value_or(0) - all.perCell * all.perCell));
  all.emptyCellsPercent = 100.0 * emptyCells_.value().value_or(0);
  return all;
}

}  // namespace pleinair::measure
