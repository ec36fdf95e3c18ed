#include "pipeline/tracking/motion/canvas_motion.h"

#include <algorithm>

#include "pipeline/tracking/image/homography.h"
#include "pipeline/tracking/motion/similarity_fit.h"

namespace pleinair::tracking {
namespace {

constexpr double kStillPx = 0.33;  // of the frame

/// Largest distance between the positions to which the two move a corner of the frame.
double apartPx(const PlaneSimilarity& a, const PlaneSimilarity& b, hal::FrameSize size) {
  double most = 0.0;
  for (const double x : {0.0, static_cast<double>(size.width)}) {
    for (const double y : {0.0, static_cast<double>(size.height)}) {
      most = std::max(most, glm::distance(a({x, y}), b({x, y})));
    }
  }
  return most;
}

/// The turn, zoom and shift nearest to a homography over the whole image, which has several px.
PlaneSimilarity nearestTo(const glm::dmat3& homography, hal::FrameSize size) {
  SimilarityFit fit;
  forGridCentres(size, [&](const glm::dvec2& px) { fit.add(px, movedBy(homography, px)); });
  return fit.nearest().value_or(PlaneSimilarity{});
}

}  // namespace

void CanvasMotion::reset() {
  firstFromFrame_ = {};
  firstFromSeen_ = {};
}

const PlaneSimilarity& CanvasMotion::follow(const ImageMotion& motion) {
  if (motion.isCut || !motion.picture) return firstFromFrame_;
  const glm::dmat3& currentFromPrevious = motion.picture->currentFromPrevious;
  if (currentFromPrevious == glm::dmat3(1.0)) return firstFromFrame_;
  firstFromSeen_ = firstFromSeen_ * nearestTo(currentFromPrevious, motion.frameSize).inverse();
  if (apartPx(firstFromSeen_, firstFromFrame_, motion.frameSize) >
      kStillPx * firstFromFrame_.scale()) {
    firstFromFrame_ = firstFromSeen_;
  }
  return firstFromFrame_;
}

}  // namespace pleinair::tracking
