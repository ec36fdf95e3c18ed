#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene/linear_picture.h"

namespace pleinair::scene {

/// A picture's light in a few numbers, from 1200 pixels spread over it.
struct PictureGlance {
  glm::dvec3 mean{0.0};  ///< linear RGB, above 0
  /// Towards where it is brighter: doublings of luminance from its middle to its edge, x right, y
  /// down.
  glm::dvec2 slope{0.0};
  double explained = 0.0;  ///< of the brightness's variance, by the slope: 0 … 1
};

PictureGlance glanceAt(const LinearPicture& picture);

}  // namespace pleinair::scene
