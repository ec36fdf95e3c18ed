#include "pipeline/measure/model_anchors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/core.hpp>

#include "pipeline/measure/input/picture.h"
#include "pipeline/measure/output_measures.h"

namespace pleinair::measure {

using marks::Anchor;

namespace {

/// The relative change of the screen area of the followed pixels within `rect`.
double growthOf(const MotionMap& motion, const cv::Rect& rect) {
  constexpr float kMost = 2;  // of a place: beside what comes before it, it is not smooth
  if (motion.shift) return 0;
  double before = 0, after = 0;
  for (int y = rect.y; y + 1 < rect.br().y; ++y) {
    for (int x = rect.x; x + 1 < rect.br().x; ++x) {
      const bool isSeen =
          motion.valid(y, x) != 0 && motion.valid(y, x + 1) != 0 && motion.valid(y + 1, x) != 0;
      if (!isSeen) continue;
      const cv::Vec2f here = motion.displacement(y, x);
      const cv::Vec2f right = motion.displacement(y, x + 1) - here;
      const cv::Vec2f down = motion.displacement(y + 1, x) - here;
      const float area = (1 + right[0]) * (1 + down[1]) - right[1] * down[0];
      before += 1;
      after += std::clamp(area, 1 / kMost, kMost);
    }
  }
  return before > 0 ? after / before - 1 : 0;
}

}  // namespace

bool ModelAnchors::isFollowed(const Anchor& anchor, const MotionMap& motion) const {
  const cv::Point2f at = imagePoint(anchor);
  return innerRect(frame_).contains(cv::Point(at)) && displacementAt(motion, at).has_value();
}

void ModelAnchors::add(std::span<const Anchor> anchors, const ModelMotionOfAnchors& motion) {
  const bool hasPast = !past_.empty() && past_.back().size() == anchors.size();
  if (hasPast && motion.sinceLast != nullptr && motion.toLast != nullptr) {
    countChanges(anchors, *motion.sinceLast, *motion.toLast);
    slip_.add(slipSince(past_.back(), anchors, *motion.sinceLast));
  }
  if (hasPast && motion.sinceLong != nullptr && past_.size() >= kLongLag) {
    longSlip_.add(slipSince(past_[past_.size() - kLongLag], anchors, *motion.sinceLong));
  }
  past_.emplace_back(anchors.begin(), anchors.end());
  if (past_.size() > kLongLag) past_.pop_front();
}

void ModelAnchors::countChanges(std::span<const Anchor> anchors, const MotionMap& sinceLast,
                                const MotionMap& toLast) {
  ++frames_;
  resized_ += std::abs(growthOf(sinceLast, innerRect(frame_)));
  for (std::size_t slot = 0; slot < anchors.size(); ++slot) {
    const Anchor& previous = past_.back()[slot];
    const Anchor& current = anchors[slot];
    const bool same = isSame(previous, current);
    if (current.isStaying() && isFollowed(current, toLast)) {
      anchors_ += 1;
      births_ += same ? 0 : 1;
    }
    const bool stays = same && (current.isStaying() || current.isCovered());
    if (previous.isStaying() && !stays && isFollowed(previous, sinceLast)) deaths_ += 1;
  }
}

std::optional<Drift> ModelAnchors::slipSince(std::span<const Anchor> earlier,
                                             std::span<const Anchor> current,
                                             const MotionMap& motion) const {
  if (earlier.size() != current.size()) return std::nullopt;
  std::vector<float> distances;
  for (std::size_t slot = 0; slot < current.size(); ++slot) {
    const bool isCompared = isSame(earlier[slot], current[slot]) && earlier[slot].isStaying() &&
                            current[slot].isStaying() && isFollowed(earlier[slot], motion);
    if (!isCompared) continue;
    const auto truth = displacementAt(motion, imagePoint(earlier[slot]));
    const cv::Point2f error =
        imagePoint(current[slot]) - imagePoint(earlier[slot]) - truth.value_or(cv::Point2f());
    distances.push_back(std::hypot(error.x, error.y));
  }
  return driftOf(std::move(distances));
}

std::optional<ModelAnchorSummary> ModelAnchors::summary() const {
  if (anchors_ == 0) return std::nullopt;
  const auto frames = static_cast<double>(frames_);
  return ModelAnchorSummary{.frames = frames_,
                            .anchors = anchors_ / frames,
                            .births = births_ / frames,
                            .deaths = deaths_ / frames,
                            .turnoverPercent = 100.0 * (births_ + deaths_) / anchors_,
                            .resizedPercent = 100.0 * resized_ / frames,
                            .slip = slip_.value(),
                            .longSlip = longSlip_.value()};
}

}  // namespace pleinair::measure
