#include "pipeline/tracking/motion/feature_tracker.h"

#include "pipeline/tracking/motion/harris_sift_tracker.h"
#include "pipeline/tracking/motion/lucas_kanade_tracker.h"

namespace pleinair::tracking {

std::unique_ptr<FeatureTracker> makeFeatureTracker(FeatureMethod method) {
  if (method == FeatureMethod::kHarrisSift) return std::make_unique<HarrisSiftTracker>();
  return std::make_unique<LucasKanadeTracker>();
}

}  // namespace pleinair::tracking
