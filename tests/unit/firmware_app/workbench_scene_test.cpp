#include "firmware_app/scene/workbench_scene.h"

#include <algorithm>
#include <cmath>

#include <glm/ext/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "hal/cameras/synthetic/synthetic_camera.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/description/scene_file.h"

namespace pleinair::app {
namespace {

constexpr hal::FrameSize kSize{640, 480};

hal::GroundTruth benchTruth() {
  hal::SteppedClock clock;
  return hal::SyntheticCamera({.size = kSize}, clock).truth(0);
}

scene::Scene parsed(const hal::GroundTruth& truth) {
  return scene::parseScene(workbenchScene(truth, kSize), "workbench.toml", {});
}

double largestDifference(const glm::dmat4& a, const glm::dmat4& b) {
  double largest = 0.0;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      largest = std::max(largest, std::abs(a[column][row] - b[column][row]));
    }
  }
  return largest;
}

/// Turns about the fixed axes x, then y, then z.
glm::dmat4 turned(double xDegrees, double yDegrees, double zDegrees) {
  glm::dmat4 pose(1.0);
  pose = glm::rotate(pose, glm::radians(zDegrees), {0.0, 0.0, 1.0});
  pose = glm::rotate(pose, glm::radians(yDegrees), {0.0, 1.0, 0.0});
  return glm::rotate(pose, glm::radians(xDegrees), {1.0, 0.0, 0.0});
}

void expectTagsOf(const hal::GroundTruth& truth) {
  const scene::Scene scene = parsed(truth);
  ASSERT_EQ(scene.tags.size(), truth.tags.size());
  for (std::size_t i = 0; i < truth.tags.size(); ++i) {
    const hal::BenchTag& tag = truth.tags[i].tag;
    EXPECT_EQ(scene.tags[i].id, tag.id);
    EXPECT_EQ(scene.tags[i].edgeMetres, tag.edgeMetres);
    ASSERT_TRUE(scene.tags[i].worldFromTag);
    EXPECT_LT(largestDifference(*scene.tags[i].worldFromTag, tag.worldFromTag), 1e-5) << tag.id;
  }
}

TEST(WorkbenchScene, HasTheCameraAndTheTagsOfTheDesk) {
  const hal::GroundTruth truth = benchTruth();
  ASSERT_FALSE(truth.tags.empty());
  expectTagsOf(truth);
  const scene::Scene scene = parsed(truth);
  ASSERT_TRUE(scene.camera);
  EXPECT_EQ(scene.camera->imageSize(), kSize);
  EXPECT_NEAR(scene.camera->intrinsics().fx, truth.intrinsics.fx, 1e-5);
  EXPECT_NEAR(scene.camera->intrinsics().fy, truth.intrinsics.fy, 1e-5);
  EXPECT_NEAR(scene.camera->intrinsics().cx, truth.intrinsics.cx, 1e-5);
  EXPECT_NEAR(scene.camera->intrinsics().cy, truth.intrinsics.cy, 1e-5);
  EXPECT_FALSE(scene.models.empty());
}

TEST(WorkbenchScene, HasTagsThatAreTurnedAnyWay) {
  for (const double x : {0.0, 33.0, -120.0, 180.0}) {
    for (const double y : {0.0, 41.0, -89.0}) {
      for (const double z : {0.0, 77.0, -160.0}) {
        hal::GroundTruth truth = benchTruth();
        glm::dmat4& pose = truth.tags[1].tag.worldFromTag;
        pose = turned(x, y, z) * scene::kAttachFromTag;
        pose[3] = glm::dvec4(0.1, -0.2, 0.3, 1.0);
        expectTagsOf(truth);
      }
    }
  }
}

TEST(WorkbenchScene, HasTagsThatStandOnTheirEdge) {
  // y at a right angle: the turns about x and z are one
  for (const double y : {90.0, -90.0}) {
    for (const double x : {0.0, 33.0, -120.0}) {
      for (const double z : {0.0, 77.0}) {
        hal::GroundTruth truth = benchTruth();
        truth.tags[0].tag.worldFromTag = turned(x, y, z) * scene::kAttachFromTag;
        expectTagsOf(truth);
      }
    }
  }
}

}  // namespace
}  // namespace pleinair::app
