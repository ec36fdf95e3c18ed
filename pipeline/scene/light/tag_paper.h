#pragma once

#include <optional>
#include <string_view>

#include <glm/vec3.hpp>

#include "pipeline/scene/light/linear_image.h"
#include "pipeline/tracking/pose/tag.h"

namespace pleinair::scene {

/// How bright a tag's paper and ink are in a picture: the light on a plane of known reflectance.
struct TagPaper {
  glm::vec3 white{0.0F};    ///< of the border around the black square, linear light; above 0
  glm::vec3 black{0.0F};    ///< of the square's own border
  float confidence = 0.0F;  ///< above 0, to 1: how large and how even it is
};

/// Cells along a tag's edge() for families with a white border around a black one, a cell each;
/// nothing for others.
std::optional<int> cellsAlongEdge(std::string_view family);

/// Reads the middle line of a tag's white and black borders, the brightest and the darkest quarter
/// of each left out, so that a finger or a glint does not count. Nothing where cells are too small
/// to be read clean (1.8 px across the border), too much lies outside the picture or in front of
/// it, or paper and ink do not differ as they do.
std::optional<TagPaper> readTagPaper(const LinearImage& picture,
                                     const tracking::TagCornersPx& corners, int cells);

}  // namespace pleinair::scene
