#include "hal/cameras/synthetic/desk_tags.h"

#include <cassert>
#include <cmath>

#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

namespace pleinair::hal {
namespace {

/// A tag face up on the desk; seen from above, its x axis is turned counter-clockwise by `angle`.
DeskTag lyingTag(int id, double edgeMetres, double x, double y, double angleDegrees) {
  const double angle = glm::radians(angleDegrees);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {id, "tag36h11", edgeMetres,
          glm::dmat4(glm::dvec4(c, s, 0, 0), glm::dvec4(s, -c, 0, 0), glm::dvec4(0, 0, -1, 0),
                     glm::dvec4(x, y, 0, 1))};
}

}  // namespace

glm::dvec3 tagCorner(double edgeMetres, int corner) {
  assert(corner >= 0 && corner < 4);
  const double half = edgeMetres / 2;
  return {corner == 1 || corner == 2 ? half : -half, corner < 2 ? half : -half, 0};
}

std::vector<DeskTag> deskTags() {
  return {lyingTag(0, 0.12, 0.12, -0.02, -6), lyingTag(1, 0.08, -0.36, -0.19, 22),
          lyingTag(2, 0.10, 0.42, 0.22, -28), lyingTag(3, 0.06, 0.09, 0.25, 100),
          lyingTag(4, 0.05, 0.36, -0.17, 171)};
}

}  // namespace pleinair::hal
