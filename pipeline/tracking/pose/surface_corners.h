#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <glm/vec2.hpp>

#include "pipeline/tracking/pose/tag.h"

namespace pleinair::tracking {

class LumaPyramid;

/// Tracks that are followed at once.
inline constexpr std::size_t kMostTracks = 130;

/// A point of the picture that is followed.
struct FeatureTrack {
  std::uint32_t id = 0;
  glm::dvec2 keyPx{0.0};  ///< in the key frame; px of the frame, pixel centres at +0.5, as all here
  glm::dvec2 px{0.0};     ///< now; where it was found last, if it is not
  bool isFound = false;
};

/// Corners of a key frame (Shi and Tomasi, "Good Features to Track", 1994), followed into each
/// later one by pyramidal Lucas-Kanade. All is measured from the key frame and not from frame to
/// frame, so that nothing drifts, and a feature that something has covered is known by its looks
/// when it comes back. A feature counts as found where its surroundings look as in the key frame
/// and lead back to where they came from.
/// One thread at a time.
class SurfaceCorners {
 public:
  SurfaceCorners();
  ~SurfaceCorners();
  SurfaceCorners(const SurfaceCorners&) = delete;
  SurfaceCorners& operator=(const SurfaceCorners&) = delete;
  SurfaceCorners(SurfaceCorners&&) = delete;
  SurfaceCorners& operator=(SurfaceCorners&&) = delete;

  /// Follows the key frame's features into the next frame (LumaFrame::pyramid()); none without a
  /// key frame, or when the size changed.
  void follow(std::shared_ptr<const LumaPyramid> now);
  /// By rising id; valid until the next call of anything.
  std::span<const FeatureTrack> tracks() const;

  /// Whether the key frame shows too little of what this one does: features lost, or gone far.
  bool isKeyStale() const;
  /// The frame followed last becomes the key frame. Its found features go on, under the same id;
  /// others are forgotten; new ones are sought where there are few, and more of them on `tags`.
  void makeKey(std::span<const TagCornersPx> tags);

  /// Forgets all.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::tracking
