#include "hal/cameras/synthetic/world/bench_tags.h"

#include <cassert>

#include <glm/ext/matrix_transform.hpp>
#include <glm/vec3.hpp>

#include "hal/cameras/synthetic/world/workbench.h"

namespace pleinair::hal {
namespace {

/// A tag that lies face up on an upright object and reads upright along the object's y.
BenchTag lying(int id, double edgeMetres, const glm::dmat4& pose, glm::dvec3 at) {
  const glm::dmat4 tag(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, -1, 0, 0), glm::dvec4(0, 0, -1, 0),
                       glm::dvec4(at, 1));
  return {id, "tag36h11", edgeMetres, pose * tag};
}

/// A tag on an object's front, upright along the object's y.
BenchTag onFront(int id, double edgeMetres, const glm::dmat4& pose, glm::dvec3 at) {
  const glm::dmat4 tag(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 0, -1, 0), glm::dvec4(0, 1, 0, 0),
                       glm::dvec4(at, 1));
  return {id, "tag36h11", edgeMetres, pose * tag};
}

}  // namespace

glm::dvec3 tagCorner(double edgeMetres, int corner) {
  assert(corner >= 0 && corner < 4);
  const double half = edgeMetres / 2;
  return {corner == 1 || corner == 2 ? half : -half, corner < 2 ? half : -half, 0};
}

std::vector<BenchTag> benchTags() {
  using namespace synthetic;  // NOLINT(google-build-using-namespace): the layout's names
  return {lying(0, 0.10, glm::dmat4(1), {0, 0, 0}),
          onFront(1, 0.085, kToolboxPose, {0.02, -kToolboxSize.y / 2, kToolboxSize.z / 2 - 0.012}),
          onFront(2, 0.08, kMachinePose, {-0.03, -kMachineSize.y / 2, kMachineSize.z / 2}),
          onFront(3, 0.10, glm::translate(glm::dmat4(1), kWallSheetCentre), {0, 0, -0.02}),
          lying(4, 0.08, kBooksPose, {0.0, 0.0, kBooksHeight})};
}

}  // namespace pleinair::hal
