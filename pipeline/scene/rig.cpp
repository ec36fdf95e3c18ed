#include "pipeline/scene/rig.h"

#include <cmath>

#include <glm/ext/matrix_transform.hpp>

namespace pleinair::scene {

glm::dmat4 parentFromNode(const NodePlace& place) {
  const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), place.translation);
  return glm::scale(moved * glm::mat4_cast(place.rotation), place.scale);
}

bool isBounded(const glm::dmat4& matrix) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!(std::abs(matrix[column][row]) <= kMostOfMatrix)) return false;  // NaN neither
    }
  }
  return true;
}

}  // namespace pleinair::scene
