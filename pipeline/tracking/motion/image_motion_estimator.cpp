#include "pipeline/tracking/motion/image_motion_estimator.h"

#include <algorithm>

#include "pipeline/tracking/image/luma_pyramid.h"
#include "pipeline/tracking/motion/cut_detector.h"
#include "pipeline/tracking/motion/dense_flow.h"
#include "pipeline/tracking/motion/feature_tracker.h"
#include "pipeline/tracking/motion/jitter_suppressor.h"
#include "pipeline/tracking/motion/static_regions.h"

namespace pleinair::tracking {
struct ImageMotionEstimator::State {
  explicit State(const ImageMotionOptions& wanted)
      : options(wanted), tracker(makeFeatureTracker(wanted.features)), hold(wanted.isMounted) {}

  ImageMotionOptions options;
  LumaFrame own;  // for frames that come as luma alone
  std::shared_ptr<const LumaPyramid> previous;
  std::unique_ptr<FeatureTracker> tracker;
  CutDetector cuts;
  JitterSuppressor hold;
  StaticRegionDetector staticRegions;
  DenseFlowEstimator flow;
  ImageMotion motion;
  std::uint64_t lastSequence = 0;

  void forget() {
    tracker->reset();
    hold.reset();
    staticRegions.reset();
    flow.reset();
  }
};

ImageMotionEstimator::ImageMotionEstimator(ImageMotionOptions options)
    : state_(std::make_unique<State>(options)) {}

ImageMotionEstimator::~ImageMotionEstimator() = default;

void ImageMotionEstimator::reset() {
  state_->forget();
  state_->cuts.reset();
  state_->previous.reset();
}

const ImageMotion& ImageMotionEstimator::follow(const hal::PlaneView& luma, hal::FrameSize size,
                                                std::uint64_t sequence) {
  state_->own.take(luma, size);
  return follow(state_->own, sequence);
}

const ImageMotion& ImageMotionEstimator::follow(LumaFrame& frame, std::uint64_t sequence) {
  State& s = *state_;
  const hal::FrameSize size = frame.size();
  if (s.previous && s.previous->frameSize() != size) reset();
  const std::shared_ptr<const LumaPyramid> current = frame.pyramid();
  const double scale = std::max(current->reduction().x, current->reduction().y);

  const std::span<const SeenFeature> seen = s.tracker->follow(current, s.staticRegions.noise());
  s.motion = {.frameSize = size, .sinceSequence = s.previous ? s.lastSequence : sequence};
  s.motion.isCut = s.cuts.isCut(*current, s.tracker->foundShare(), s.staticRegions.noise());
  if (s.motion.isCut) {
    s.forget();
    s.tracker->follow(current, s.staticRegions.noise());
  } else {
    s.hold.update(seen, size, scale);
    s.motion.features = s.hold.features();
    if (!s.cuts.isBlank()) s.motion.picture = s.hold.picture();
  }
  if (s.options.staticRegions) s.staticRegions.update(*current, s.motion.picture);
  if (s.options.staticRegions && !s.motion.isCut) s.motion.still = s.staticRegions.fields();
  if (s.options.flow && !s.motion.isCut) {
    s.flow.update(*s.previous, *current, s.motion.picture,
                  s.options.staticRegions ? &s.staticRegions : nullptr, s.staticRegions.noise());
    s.motion.flow = s.flow.flow();
  }
  // The pyramid averages several frame px, which lowers the noise.
  s.motion.noiseLevels = s.staticRegions.noise() * scale;
  s.previous = current;
  s.lastSequence = sequence;
  return s.motion;
}

}  // namespace pleinair::tracking
