#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <glm/vec2.hpp>

namespace pleinair::tracking {

class LumaPyramid;

/// How features are found again. As the words of configurations name them.
enum class FeatureMethod {
  kLucasKanade,  ///< fast, sub-pixel, without drift
  kHarrisSift    ///< the thesis's (§4.3.2), to compare with
};

/// A feature that is seen in a frame, as measured: px of the frame, pixel centres at +0.5.
struct SeenFeature {
  std::uint32_t id = 0;  ///< the same as long as it is followed
  glm::dvec2 px{0.0};
  double errorPx = 0.0;        ///< predicted, of what it has moved since the frame before
  bool wasSeen = false;        ///< in the frame before, too
  glm::dvec2 previousPx{0.0};  ///< where it was there
};

/// Finds features of a camera's picture and finds them again. One thread at a time.
class FeatureTracker {
 public:
  virtual ~FeatureTracker() = default;

  /// Takes the next frame, which is not changed as long as it is shared, and its pixels' noise
  /// (levels). By rising id, at most kMostMovedFeatures of them; valid until the next call.
  virtual std::span<const SeenFeature> follow(std::shared_ptr<const LumaPyramid> now,
                                              double noise) = 0;
  /// Of the features seen in the frame before, the part that was found; 0 of none.
  virtual double foundShare() const = 0;
  /// Forgets all.
  virtual void reset() = 0;
};

std::unique_ptr<FeatureTracker> makeFeatureTracker(FeatureMethod method);

}  // namespace pleinair::tracking
