#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "hal/image.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/tracking/pose/tracker.h"

namespace pleinair::app {

/// Gathers over the frames of a recording what shows that its scene file is wrong: tags that are
/// never seen, of another family, mirrored, or elsewhere than the scene says. One thread.
class SceneObserver {
 public:
  /// `scene` outlives this.
  explicit SceneObserver(const scene::Scene& scene) : scene_(scene) {}

  /// The next frame, and what was tracked in it.
  void take(const hal::ImageView& frame, const tracking::TrackingResult& tracking);

  /// One line for each mistake, with its remedy. Where no tag was seen at all, searches a few kept
  /// frames for those of other families, which takes a second.
  std::vector<std::string> findings() const;

  std::uint64_t frames() const { return frames_; }
  /// The frames in which a tag was seen.
  std::uint64_t sightings(int id) const;

 private:
  /// How a tag was seen beside the others that have a place in the world.
  struct Placement {
    std::uint64_t frames = 0;
    std::uint64_t elsewhere = 0;   ///< frames in which it was not where the scene places it
    glm::dmat4 worldFromTag{1.0};  ///< where it was last
  };
  void comparePlace(const tracking::TrackedTag& tag, const glm::dmat4& cameraFromWorld);
  std::string familyFinding() const;

  const scene::Scene& scene_;
  std::uint64_t frames_ = 0;
  std::uint64_t mirrored_ = 0;  ///< frames in which tags were seen, but mirrored
  std::map<int, std::uint64_t> sightings_;
  std::map<int, Placement> placements_;
  std::vector<hal::Image> tagless_;  ///< grey; a few frames, until a tag is seen
};

}  // namespace pleinair::app
