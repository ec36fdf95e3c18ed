#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/marks/anchors/anchor.h"
#include "pipeline/measure/mean.h"

namespace pleinair::measure {

/// Distances of anchors from where the true motion takes them (px).
struct Drift {
  double median = 0;
  double percentile95 = 0;
  double rms = 0;
};

/// The drift of one frame's distances; nothing if there are none.
std::optional<Drift> driftOf(std::vector<float> distances);

/// Mean drift over frames.
class MeanDrift {
 public:
  void add(const std::optional<Drift>& drift);
  std::optional<Drift> value() const;

 private:
  Mean median_, percentile95_, square_;
};

/// Whether a slot holds the same anchor in two successive frames.
bool isSame(const marks::Anchor& previous, const marks::Anchor& current);

/// Anchors have pixel centres at +0.5; images here have them at whole numbers.
cv::Point2f imagePoint(const marks::Anchor& anchor);

}  // namespace pleinair::measure
