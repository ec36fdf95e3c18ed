#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <glm/vec2.hpp>

#include "pipeline/tracking/pose/tag.h"

namespace pleinair::tracking {

class LumaPyramid;

/// Most tracks that are followed at once.
inline constexpr std::size_t kMaxTracks = 130;

/// A followed point of the image.
struct FeatureTrack {
  std::uint32_t id = 0;
  /// Position in the key frame; px of the frame, pixel centres at +0.5, as all positions here.
  glm::dvec2 keyPx{0.0};
  glm::dvec2 px{0.0};  ///< position in this frame; the last one found if it is lost
  bool isFound = false;
};

/// Corners of a key frame (Shi and Tomasi, "Good Features to Track", 1994), followed into each
/// later frame by pyramidal Lucas-Kanade. Motion is measured from the key frame and not from frame
/// to frame, so that nothing drifts, and a feature that was covered is recognised by its appearance
/// when it reappears. A feature counts as found where its window looks as in the key frame and
/// leads back to its origin. One thread at a time.
class SurfaceCorners {
 public:
  SurfaceCorners();
  ~SurfaceCorners();
  SurfaceCorners(const SurfaceCorners&) = delete;
  SurfaceCorners& operator=(const SurfaceCorners&) = delete;
  SurfaceCorners(SurfaceCorners&&) = delete;
  SurfaceCorners& operator=(SurfaceCorners&&) = delete;

  /// Follows the key frame's features into the next frame (LumaFrame::pyramid()); there are none
  /// without a key frame, or when the size changed.
  void follow(std::shared_ptr<const LumaPyramid> now);
  /// By rising id; valid until the next call of any function.
  std::span<const FeatureTrack> tracks() const;

  /// Whether the key frame shares too little with this frame: features are lost, or have moved far.
  bool isKeyStale() const;
  /// Makes the last followed frame the key frame. Found features keep their id, others are
  /// forgotten. New ones are added where there are few, more densely on `tags`.
  void makeKey(std::span<const TagCornersPx> tags);

  /// Forgets all features and the key frame.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::tracking
