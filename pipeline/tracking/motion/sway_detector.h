#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "hal/pixel_format.h"
#include "pipeline/tracking/motion/feature_tracker.h"

namespace pleinair::tracking {

/// Tells a camera that stands before things that sway, such as leaves in the wind, from one that
/// moves. From one frame to the next, a fit finds a motion in either. Over half a second and more,
/// a camera's motion takes its features along together; what sways scatters about its places. One
/// thread at a time.
class SwayDetector {
 public:
  /// Takes the features of the next frame, by rising id; px of the frame. `scale`: size of a px of
  /// the measured image, in frame px. Returns whether the camera stands, as far as this can tell.
  bool stands(std::span<const SeenFeature> seen, hal::FrameSize size, double scale);

  /// Treats the next frame as the first one.
  void reset();

 private:
  struct Place {
    std::uint32_t id = 0;
    glm::dvec2 px{0.0};
  };

  void keep(std::span<const SeenFeature> seen);
  void match(std::span<const SeenFeature> seen);
  bool scatters(hal::FrameSize size, double scale);

  std::vector<Place> reference_;  // by rising id
  int frames_ = 0;                // since the reference
  int scattered_ = 0;             // consecutive frames
  std::vector<glm::dvec2> from_;  // of features that the reference has, too
  std::vector<glm::dvec2> to_;
  std::vector<double> distances_;
  std::vector<double> residuals_;
};

}  // namespace pleinair::tracking
