#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include <glm/vec2.hpp>

#include "hal/clock.h"
#include "pipeline/tracking/image/luma.h"

namespace pleinair::tracking {

/// A face in the camera image: the square from the brows to the chin, px of the frame.
struct Face {
  glm::dvec2 centre{0.0};
  double sidePx = 0.0;
  double presence = 0.0;  ///< in (0, 1]: it comes and goes gradually
};

/// Most faces that are followed; others are not asked until one of them goes.
inline constexpr std::size_t kMaxFaces = 8;

/// Finds faces that look at the camera and follows them, also while they turn away for some
/// seconds. It tells where a face is, not whose. A classifier searches the whole image in about
/// half a second, then the next one does; between searches, faces are followed by their appearance.
/// A face at rest rests exactly. Measures in an image of at most 320 px, in which a face is 20 px
/// wide at least. In steady state only OpenCV allocates. One thread at a time; uses OpenCV's
/// threads.
class FaceTracker {
 public:
  /// Throws hal::Failure if OpenCV does not read its classifiers.
  FaceTracker();
  ~FaceTracker();
  FaceTracker(const FaceTracker&) = delete;
  FaceTracker& operator=(const FaceTracker&) = delete;
  FaceTracker(FaceTracker&&) = delete;
  FaceTracker& operator=(FaceTracker&&) = delete;

  /// Takes the next frame. The first one, one of another size, and one with `isCut` are searched as
  /// a whole, and what is found is there at once. The result is valid until the next call.
  std::span<const Face> follow(LumaFrame& frame, hal::TimePoint captureTime, bool isCut);
  /// Treats the next frame as the first one.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::tracking
