#pragma once

#include <optional>
#include <string_view>

#include <glm/vec3.hpp>

#include "pipeline/scene/light/linear_image.h"
#include "pipeline/tracking/pose/tag.h"

namespace pleinair::scene {

/// Brightness of a tag's paper and ink in an image, and so the light on a plane of known
/// reflectance.
struct TagPaper {
  glm::vec3 white{0.0F};    ///< the border around the black square, linear light; above 0
  glm::vec3 black{0.0F};    ///< the square's own border
  float confidence = 0.0F;  ///< above 0, up to 1: by size and uniformity
};

/// Number of cells along a tag's edge(), for families with a white border around a black one, each
/// one cell wide; nothing for other families.
std::optional<int> cellsAlongEdge(std::string_view family);

/// Reads the centre lines of a tag's white and black borders. The brightest and the darkest quarter
/// of each are dropped, so that a finger or a glint does not matter. Returns nothing where cells
/// are too small (1.8 px across the border), too much lies outside of the image or in front of it,
/// or paper and ink differ too little.
std::optional<TagPaper> readTagPaper(const LinearImage& picture,
                                     const tracking::TagCornersPx& corners, int cells);

}  // namespace pleinair::scene
