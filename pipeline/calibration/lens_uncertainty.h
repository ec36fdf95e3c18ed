#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "pipeline/calibration/lens_fit.h"

namespace pleinair::calibration {

/// Uncertainty of the lens at one place of the image.
struct PlaceUncertainty {
  glm::dvec2 px{0.0};
  double sigmaPx = 0.0;
};

/// The standard deviation by which rays may appear elsewhere than the fit says, at places over the
/// whole image, from the fit's covariance. A rotation of the camera common to all places does not
/// count, since poses absorb it. mrcal calls this the projection uncertainty. Infinite where the
/// lens has no inverse.
std::vector<PlaceUncertainty> placeUncertainties(const LensFit& fit);

/// Whether the distortion folds over within the image's corners or a little beyond. A fitted
/// polynomial may do so: two rays then share one place, or a ray further out appears further in.
bool foldsInImage(const tracking::CameraModel& camera);

}  // namespace pleinair::calibration
