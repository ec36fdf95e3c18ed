#include "pipeline/measure/anchor_drift.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pleinair::measure {

std::optional<Drift> driftOf(std::vector<float> distances) {
  if (distances.empty()) return std::nullopt;
  double squares = 0;
  for (const float distance : distances) squares += static_cast<double>(distance) * distance;
  std::ranges::sort(distances);
  const auto at = [&distances](double share) {
    const double last = static_cast<double>(distances.size() - 1);
    return static_cast<double>(distances[static_cast<std::size_t>(share * last)]);
  };
  return Drift{.median = at(0.5),
               .percentile95 = at(0.95),
               .rms = std::sqrt(squares / static_cast<double>(distances.size()))};
}

void MeanDrift::add(const std::optional<Drift>& drift) {
  if (!drift) return;
  median_ += {drift->median, 1.0};
  percentile95_ += {drift->percentile95, 1.0};
  square_ += {drift->rms * drift->rms, 1.0};
}

std::optional<Drift> MeanDrift::value() const {
  if (!median_.value()) return std::nullopt;
  return Drift{.median = *median_.value(),
               .percentile95 = *percentile95_.value(),
               .rms = std::sqrt(*square_.value())};
}

bool isSame(const marks::Anchor& previous, const marks::Anchor& current) {
  return previous.isAlive() && current.isAlive() && previous.seed == current.seed &&
         !current.isBorn();
}

cv::Point2f imagePoint(const marks::Anchor& anchor) {
  return {anchor.px.x - 0.5F, anchor.px.y - 0.5F};
}

}  // namespace pleinair::measure
