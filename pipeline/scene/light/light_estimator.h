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

/// A smoothed vector with hysteresis. The output stays constant until the smoothed vector has left
/// a band around it, then follows until the two meet, so that it rests on a static scene.
class FilteredVector {
 public:
  /// `share`: part of the distance to `target` that one step covers, 0 … 1. The first target is
  /// taken whole.
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

/// Estimates the light on the places that models are attached to, from camera images.
///
/// Level and colour are those of white paper of the place's own tag, so that a white model is as
/// white as the paper. While the paper cannot be read, they keep their ratio to the image's mean;
/// before it was ever read, they are those of tags that face the same way, or else follow the
/// grey-world assumption.
///
/// Direction and strength of the key light follow from the paper of all visible tags, as far as
/// these face different ways (light_fit.h). The rest comes from a prior: a light from the upper
/// left behind the viewer as the place was first seen, pulled towards the brighter side of the
/// image if a slope explains much of its brightness.
///
/// Level and colour follow the camera's exposure within half a second. The key light's direction
/// and share follow in seconds; they are kept in the place's own frame, so that a moving camera
/// does not turn them. On a static scene noise moves nothing. The first frame is taken unfiltered.
/// After times that go back, or a pause of more than half a second, the next level is taken
/// unfiltered; reset() forgets everything.
///
/// One thread at a time; allocates only when constructed. About 0.1 ms per frame.
class LightEstimator {
 public:
  /// `places`: the tags that models are attached to; nothing for the world. `towardKey`: the
  /// direction to the key light in each place's attach frame, if it is known.
  LightEstimator(std::span<const tracking::TagMarker> markers, std::string_view tagFamily,
                 std::span<const std::optional<int>> places,
                 const std::optional<glm::dvec3>& towardKey = std::nullopt);

  /// Takes the next frame. Precondition: image.isComplete(), and `tracked` is of the same frame.
  void follow(const hal::ImageView& image, const tracking::TrackingResult& tracked,
              hal::TimePoint captureTime);

  /// Light per place, in its attach frame; white before the first frame. Owned by the estimator.
  std::span<const PlaceLighting> lights() const { return lights_; }

  void reset();

 private:
  /// The paper of a tag in this frame.
  struct Reading {
    int id = 0;
    glm::dvec3 cameraNormal{0.0};  ///< out of the tag
    TagPaper paper;
  };
  struct Place {
    std::optional<int> tagId;
    std::optional<glm::dmat4> worldFromTag;
    FilteredVector level;    ///< of white paper
    glm::dvec3 ofMean{0.0};  ///< level relative to the image's mean, when paper was last read
    bool hasOwnPaper = false;
    glm::dvec3 towardPrior{0.0};
    FilteredVector keyVector;  ///< as LightFit's, relative to the level
    FilteredVector key, sky, ground;
    double seconds = 0.0;  ///< time for which the key light was followed
  };
  /// Time since the last frame.
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
  // Readings of the last frame.
  std::vector<Reading> readings_;
  std::vector<LightSample> samples_;
  ImageStatistics statistics_;
};

}  // namespace pleinair::scene
