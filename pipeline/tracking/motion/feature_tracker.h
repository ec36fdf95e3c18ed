#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <glm/vec2.hpp>

namespace pleinair::tracking {

class LumaPyramid;

/// Method for following features. The enumerators match the words in configurations.
enum class FeatureMethod {
  kLucasKanade,  ///< fast, sub-pixel, without drift
  kHarrisSift    ///< the thesis's (§4.3.2), for comparison
};

/// A feature seen in a frame, as measured: px of the frame, pixel centres at +0.5.
struct SeenFeature {
  std::uint32_t id = 0;  ///< constant while the feature is followed
  glm::dvec2 px{0.0};
  double errorPx = 0.0;        ///< predicted error of its motion since the previous frame
  bool wasSeen = false;        ///< in the previous frame
  glm::dvec2 previousPx{0.0};  ///< position there
};

/// Finds features in a camera image and follows them from frame to frame. One thread at a time.
class FeatureTracker {
 public:
  virtual ~FeatureTracker() = default;

  /// Takes the next frame and its pixel noise (levels). The frame is not changed while it is
  /// shared. Returns the features by rising id, at most kMaxMovedFeatures; valid until the next
  /// call.
  virtual std::span<const SeenFeature> follow(std::shared_ptr<const LumaPyramid> current,
                                              double noise) = 0;
  /// Part of the previous frame's features that were found in this one; 0 if there were none.
  virtual double foundShare() const = 0;
  /// Forgets all features.
  virtual void reset() = 0;
};

std::unique_ptr<FeatureTracker> makeFeatureTracker(FeatureMethod method);

}  // namespace pleinair::tracking
