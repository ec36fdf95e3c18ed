#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "pipeline/calibration/lens_fit.h"

namespace pleinair::calibration {

/// How well a place of the picture is known.
struct PlaceCertainty {
  glm::dvec2 px{0.0};
  double sigmaPx = 0.0;
};

/// By how much a ray may appear elsewhere than the fit says, over the whole picture from border to
/// border, from the fit's covariance. A turn of the camera that all places share does not count: it
/// goes into poses. mrcal calls this the projection uncertainty.
/// Infinite where the lens has no inverse.
std::vector<PlaceCertainty> placeCertainties(const LensFit& fit);

/// Whether the lens, as far as the picture's corners and a little beyond, has one ray for each
/// place, and rays further out go further out: a fitted polynomial may fold back.
bool foldsInPicture(const tracking::CameraModel& camera);

}  // namespace pleinair::calibration
