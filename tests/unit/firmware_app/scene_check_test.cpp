#include "firmware_app/scene/scene_check.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/scene/description/scene_file.h"

namespace pleinair::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

scene::Scene sceneWith(const std::string& model) {
  return scene::parseScene(
      "[[tag]]\nid = 0\nedge_m = 0.1\nposition_m = [0, 0, 0]\n[[model]]\n"
      "attach = \"tag:0\"\nsource = \"builtin:box\"\n" +
          model,
      "test", {});
}

TEST(SceneCheck, TellsTheSizeAndPlaceOfAModel) {
  const scene::Scene scene = sceneWith("size_m = [0.2, 0.1, 0.05]\nposition_m = [0, 0, 0.1]\n");
  const AxisBox box = attachedBox(scene.models[0]);
  EXPECT_NEAR(box.most.x - box.least.x, 0.2, 1e-6);
  EXPECT_NEAR(box.most.y - box.least.y, 0.1, 1e-6);
  EXPECT_NEAR(box.most.z - box.least.z, 0.05, 1e-6);
  EXPECT_NEAR(box.least.z, 0.1, 1e-6);
  EXPECT_THAT(modelLines(scene),
              ElementsAre("model 1: on tag 0, 0.2 x 0.1 x 0.05 m along its x, y, z; from 0.1 to "
                          "0.15 m above it"));
}

TEST(SceneCheck, TurnsTheBoxWithTheModel) {
  const scene::Scene scene = sceneWith("size_m = [0.2, 0.1, 0.05]\nrotation_deg = [0, 0, 90]\n");
  const AxisBox box = attachedBox(scene.models[0]);
  EXPECT_NEAR(box.most.x - box.least.x, 0.1, 1e-6);
  EXPECT_NEAR(box.most.y - box.least.y, 0.2, 1e-6);
}

TEST(SceneCheck, FindsAModelWhoseUpIsY) {
  scene::Scene scene = sceneWith("size_m = [0.1, 0.3, 0.1]\nposition_m = [0, 0.15, -0.05]\n");
  EXPECT_THAT(placementFindings(scene), IsEmpty()) << "what the program itself builds is right";
  scene.models[0].source = scene::FileSource{"robot.glb"};
  EXPECT_THAT(placementFindings(scene), ElementsAre(HasSubstr("rotation_deg = [90, 0, 0]")));
  scene.models[0].attachFromModel =
      glm::rotate(glm::dmat4(1.0), 1.5707963, {1.0, 0.0, 0.0}) * scene.models[0].attachFromModel;
  EXPECT_THAT(placementFindings(scene), IsEmpty()) << "that remedy is one";
}

TEST(SceneCheck, NamesModelsThatAreFarTooSmallOrLarge) {
  EXPECT_THAT(sceneWith("scale = 0.001\n").notices,
              ElementsAre(testing::AllOf(HasSubstr("m across here"), HasSubstr("makes it 0.2 m"))));
  EXPECT_THAT(sceneWith("scale = 1000\n").notices, ElementsAre(HasSubstr("m across here")));
  EXPECT_THAT(sceneWith("").notices, IsEmpty());
}

TEST(SceneCheck, DrawsTagsAxesAndBoxes) {
  const scene::Scene scene = sceneWith("size_m = [0.1, 0.1, 0.1]\n");
  const tracking::CameraModel camera = scene::assumedCamera({320, 240});
  hal::Image picture({.pixelFormat = hal::PixelFormat::kRgb8, .size = {320, 240}});
  glm::dmat4 cameraFromTag(1.0);
  cameraFromTag[3] = {0.0, 0.0, 0.5, 1.0};
  const tracking::TrackedTag tag{
      .id = 0,
      .corners = {glm::dvec2(130, 150), {190, 150}, {190, 90}, {130, 90}},
      .cameraFromTag = cameraFromTag};
  const std::array tags{tag};
  drawSceneCheck(picture, scene, camera, {.tags = tags});
  const auto pixel = [&](int x, int y) {
    const auto row = picture.row(0, y).subspan(3 * static_cast<std::size_t>(x), 3);
    return std::array<int, 3>{row[0], row[1], row[2]};
  };
  EXPECT_GT(pixel(130, 120)[0], 200) << "the tag's left edge, yellow";
  EXPECT_GT(pixel(130, 120)[1], 160);
  EXPECT_EQ(pixel(130, 120)[2], 0);
  EXPECT_GT(pixel(180, 120)[0], 150) << "x to the right, red";
  EXPECT_LT(pixel(180, 120)[1], 90);
  EXPECT_GT(pixel(160, 100)[1], 120) << "y to the top, green";
}

}  // namespace
}  // namespace pleinair::app
