#include <chrono>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "hal/cameras/synthetic/camera_path.h"

namespace pleinair::hal::synthetic {
namespace {

using std::chrono::milliseconds;

struct Placed {
  glm::dvec3 eye;
  glm::dvec3 forward;
};

Placed placed(const glm::dmat4& cameraFromWorld) {
  const glm::dmat4 worldFromCamera = glm::inverse(cameraFromWorld);
  return {glm::dvec3(worldFromCamera[3]), glm::dvec3(worldFromCamera[2])};
}

TEST(HandheldPath, LooksDownAtTheDeskAtASlant) {
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    const HandheldPath path(seed);
    for (int t = 0; t < 60; ++t) {
      const glm::dmat4 cameraFromWorld = path.cameraFromWorld(milliseconds(997 * t));
      EXPECT_NEAR(glm::determinant(glm::dmat3(cameraFromWorld)), 1, 1e-12);
      const Placed at = placed(cameraFromWorld);
      const double slant = glm::degrees(std::acos(-at.forward.z));
      EXPECT_GT(slant, 23);
      EXPECT_LT(slant, 49);
      EXPECT_GT(at.eye.z, 0.4);
      EXPECT_LT(at.eye.z, 0.9);
      EXPECT_LT(cameraFromWorld[2].y, 0) << "the world's z is up in the picture";
    }
  }
}

TEST(HandheldPath, MovesSmoothlyButNeverRests) {
  const HandheldPath path(1);
  for (int frame = 0; frame < 600; ++frame) {
    const Placed before = placed(path.cameraFromWorld(Duration(33'333'333LL * frame)));
    const Placed after = placed(path.cameraFromWorld(Duration(33'333'333LL * (frame + 1))));
    const double step = glm::distance(before.eye, after.eye);
    EXPECT_GT(step, 1e-5);
    EXPECT_LT(step, 0.02);
    EXPECT_LT(glm::degrees(glm::distance(before.forward, after.forward)), 1.5);
  }
}

}  // namespace
}  // namespace pleinair::hal::synthetic
