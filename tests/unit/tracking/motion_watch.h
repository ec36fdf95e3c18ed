#pragma once

#include <cstdint>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "pipeline/tracking/motion/image_motion_estimator.h"
#include "tests/support/textured_plane.h"

namespace pleinair::tracking {

/// Feeds an estimator with a camera's views of a wall.
class Watch {
 public:
  explicit Watch(ImageMotionOptions options = {}) : estimator_(options) {}

  const ImageMotion& see(const hal::Image& image) {
    const hal::ImageView view = image.view();
    return estimator_.follow(view.planes[0], view.format.size, sequence_++);
  }
  /// The next view of the wall, moved by a step, with noise that differs from frame to frame.
  const ImageMotion& step(const glm::dmat3& currentFromPrevious) {
    view_.wallFromFrame = view_.wallFromFrame * glm::inverse(currentFromPrevious);
    ++view_.noiseSeed;
    return see(support::renderWall(view_));
  }
  /// The same with another object in front of the wall.
  const ImageMotion& stepBehind(const glm::dmat3& currentFromPrevious,
                                const support::WallView& front, const glm::ivec2& from,
                                const glm::ivec2& to) {
    view_.wallFromFrame = view_.wallFromFrame * glm::inverse(currentFromPrevious);
    ++view_.noiseSeed;
    hal::Image image = support::renderWall(view_);
    support::overlayWall(image, front, from, to);
    return see(image);
  }
  support::WallView& view() { return view_; }
  void reset() { estimator_.reset(); }

 private:
  ImageMotionEstimator estimator_;
  support::WallView view_{.noiseSigma = 2.0};
  std::uint64_t sequence_ = 7;
};

}  // namespace pleinair::tracking
