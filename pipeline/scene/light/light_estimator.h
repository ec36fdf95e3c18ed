#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "hal/clock.h"
#include "hal/image.h"
#include "pipeline/scene/light/light_fit.h"
#include "pipeline/scene/light/lighting.h"
#include "pipeline/scene/light/linear_image.h"
#include "pipeline/scene/light/tag_paper.h"
#include "pipeline/tracking/pose/tracker.h"

namespace pleinair::scene {

/// A vector that follows another, noisy one smoothly, and rests on a still scene: what is shown
/// stays put until the smoothed vector has left a band around it, then goes along until they meet.
class FilteredVector {
 public:
  /// `share`: of the way to `target` that is gone at once, 0 … 1; the first target is taken whole.
  void follow(const glm::dvec3& target, double share, double band) {
    if (!hasValue_) {
      smoothed_ = shown_ = target;
      hasValue_ = true;
      return;
    }
    smoothed_ += share * (target - smoothed_);
    const double apart = glm::distance(smoothed_, shown_);
    isMoving_ = apart > (isMoving_ ? 0.25 * band : band);
    if (isMoving_) shown_ += share * (smoothed_ - shown_);
  }
  void forget() { *this = {}; }

  bool hasValue() const { return hasValue_; }
  const glm::dvec3& value() const { return shown_; }

 private:
  glm::dvec3 smoothed_{0.0};
  glm::dvec3 shown_{0.0};
  bool hasValue_ = false;
  bool isMoving_ = false;
};

/// The light on the places that models are attached to, from the camera's pictures.
///
/// Its level and colour are those of the place's own tag's white paper, so that a white model is as
/// white as the paper. Where that cannot be read, they stay as they were beside the picture's mean;
/// before it ever was, they are those of tags that face the same way, else a grey world's.
///
/// Where the key light is, and how strong, follows from the paper of all tags that are seen, as far
/// as they face different ways (light_fit.h). What they leave open is taken from a prior: the upper
/// left behind the viewer as the place was first seen, pulled to where the picture is brighter if
/// a slope explains much of it.
///
/// Level and colour follow the camera's exposure within half a second; the key light's direction
/// and share, which are kept in the place's own frame so that a moving camera does not turn them,
/// in seconds. Both rest on a still scene: noise moves nothing. The first frame is taken as it is.
/// Times that go back or a pause of more than half a second make the next level a first one;
/// reset() forgets all.
///
/// One thread at a time; allocates nothing after its making. About 0.1 ms a frame.
class LightEstimator {
 public:
  /// `places`: the tags that models are attached to; nothing for the world. `towardKey`: where the
  /// key light is, if that is known, in each place's attach frame.
  LightEstimator(std::span<const tracking::TagMarker> markers, std::string_view tagFamily,
                 std::span<const std::optional<int>> places,
                 const std::optional<glm::dvec3>& towardKey = std::nullopt);

  /// Precondition: image.isComplete(), and `tracked` is of it.
  void follow(const hal::ImageView& image, const tracking::TrackingResult& tracked,
              hal::TimePoint captureTime);

  /// Of each place, in its attach frame; before the first frame, a white one. The estimator's.
  std::span<const PlaceLighting> lights() const { return lights_; }

  void reset();

 private:
  /// A tag's paper in this frame.
  struct Reading {
    int id = 0;
    glm::dvec3 cameraNormal{0.0};  ///< out of the tag
    TagPaper paper;
  };
  struct Place {
    std::optional<int> tagId;
    std::optional<glm::dmat4> worldFromTag;
    FilteredVector level;    ///< white paper
    glm::dvec3 ofMean{0.0};  ///< the level beside the picture's mean, when paper was last read
    bool hasOwnPaper = false;
    glm::dvec3 towardPrior{0.0};
    FilteredVector keyVector;  ///< as LightFit's, relative to the level
    FilteredVector key, sky, ground;
    double seconds = 0.0;  ///< for which the key light was followed
  };
  /// How far a frame is from the last one.
  struct Step {
    bool isFirst = true;
    double seconds = 0.0;
  };

  Step stepTo(hal::TimePoint captureTime);
  void readPapers(const LinearImage& picture, const tracking::TrackingResult& tracked);
  const Reading* paperOf(const Place& place) const;
  std::optional<glm::dvec3> whiteFacing(const glm::dmat3& attachFromCamera) const;
  std::optional<glm::dvec3> followLevel(Place& place,
                                        const std::optional<glm::dmat3>& attachFromCamera,
                                        const Step& step);
  void followPrior(Place& place, const glm::dmat3& attachFromCamera, const Step& step) const;
  void followKey(Place& place, const glm::dvec3& white, const glm::dmat3& attachFromCamera,
                 const Step& step);
  Lighting composed(const Place& place) const;

  std::vector<tracking::TagMarker> markers_;
  std::optional<int> cells_;
  std::optional<glm::dvec3> towardKey_;
  std::vector<Place> places_;
  std::vector<PlaceLighting> lights_;
  std::optional<hal::TimePoint> lastTime_;
  // Of the last frame.
  std::vector<Reading> readings_;
  std::vector<LightSample> samples_;
  ImageStatistics statistics_;
};

}  // namespace pleinair::scene
