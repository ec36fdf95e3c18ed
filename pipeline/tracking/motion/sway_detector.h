#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "hal/pixel_format.h"
#include "pipeline/tracking/motion/feature_tracker.h"

namespace pleinair::tracking {

/// Tells a camera that stands before things that sway, such as leaves in the wind, from one that
/// moves. From one frame to the next, a fit finds a motion in either. Over more frames, a camera's
/// motion takes its features along, all together or, with parallax, each further and further; what
/// sways scatters about its places, and comes back. One thread at a time.
class SwayDetector {
 public:
  /// Takes the features of the next frame, by rising id; px of the frame. `scale`: size of a px of
  /// the measured image, in frame px. Returns whether the camera is known to stand before what
  /// sways.
  bool stands(std::span<const SeenFeature> seen, hal::FrameSize size, double scale);

  /// Treats the next frame as the first one.
  void reset();

 private:
  struct Place {
    std::uint32_t id = 0;
    glm::dvec2 px{0.0};
  };
  using Places = std::vector<Place>;  // by rising id
  /// How features lie beside the reference: the medians of …
  struct Comparison {
    double distancePx = 0.0;
    double residualPx = 0.0;   ///< what the best similarity leaves of it
    double errorPx = 0.0;      ///< predicted
    double correlation = 0.0;  ///< of their motion before and after the middle; 1: they go on
    bool isKnown = false;
  };

  void begin(std::span<const SeenFeature> seen);
  void keepMiddle(std::span<const SeenFeature> seen);
  void match(std::span<const SeenFeature> seen);
  Comparison compare(hal::FrameSize size, double scale);

  Places reference_;
  Places middle_;      // after a quarter to a half of the time since the reference
  Places latest_;      // the next middle
  int frames_ = 0;     // since the reference
  int together_ = 0;   // consecutive frames in which a similarity takes features along
  int scattered_ = 0;  // consecutive frames in which they scatter
  int trusted_ = 0;    // frames in which an earlier reference's word still holds
  // These hold the features that the reference has, too.
  std::vector<glm::dvec2> from_;
  std::vector<glm::dvec2> between_;  // in the middle; those that it has
  std::vector<glm::dvec2> to_;
  std::vector<bool> hasBetween_;
  std::vector<double> distances_;
  std::vector<double> residuals_;
  std::vector<double> errors_;
};

}  // namespace pleinair::tracking
