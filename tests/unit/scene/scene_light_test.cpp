#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "config/config_error.h"
#include "pipeline/scene/description/scene_file.h"
#include "pipeline/scene/description/scene_tables.h"
#include "pipeline/scene/light/lighting.h"
#include "pipeline/scene/render/scene_uniforms.h"

namespace pleinair::scene {
namespace {

Light light(const std::string& keys) {
  return parseScene("[light]\n" + keys, "scene.toml", {}).light;
}

std::string mistake(const std::string& keys) {
  try {
    light(keys);
  } catch (const config::ConfigError& error) {
    return error.what();
  }
  return "none";
}

TEST(SceneLight, IsEstimatedUnlessTheSceneSaysOtherwise) {
  EXPECT_TRUE(light("").isEstimated);
  EXPECT_FALSE(light("").hasDirection);
  EXPECT_TRUE(light("direction = [0, 0, 2]").isEstimated);
  EXPECT_TRUE(light("direction = [0, 0, 2]").hasDirection);
  EXPECT_FALSE(light("mode = \"fixed\"").isEstimated);
}

TEST(SceneLight, ReadsColoursAsLinearLight) {
  const Light read =
      light("mode = \"fixed\"\nkey = \"#ffffff\"\nambient = [0, 0.5, 1]\nshadow = 0.25");
  EXPECT_EQ(*read.key, glm::vec3(1.0F));
  EXPECT_NEAR(read.ambient->g, 0.2140, 1e-4);
  EXPECT_EQ(read.shadow, 0.25F);
}

TEST(SceneLight, RefusesWhatMeansNothing) {
  EXPECT_THAT(mistake("key = \"#ffffff\""),
              testing::HasSubstr("scene.toml:2: light.key: found one, but the light is estimated"));
  EXPECT_THAT(mistake("mode = \"auto\""), testing::HasSubstr("allowed: estimated, fixed"));
  EXPECT_THAT(mistake("shadow = 1.5"), testing::HasSubstr("light.shadow"));
  EXPECT_THAT(mistake("direction = [0, 0, 0]"), testing::HasSubstr("has no length"));
}

TEST(Lighting, FixedIsWhiteOnThePlane) {
  const Lighting usual = fixedLighting({}, glm::dmat3(1.0));
  EXPECT_EQ(usual.white, glm::vec3(1.0F));
  const glm::vec3 onPlane = usual.sky + usual.towardKey.z * usual.key;
  EXPECT_NEAR(onPlane.g, 1.0F, 1e-6F);
  EXPECT_NEAR(glm::distance(shadeTint(usual), glm::vec3(1.0F)), 0.0F, 1e-6F);

  const Light dim = light(
      "mode = \"fixed\"\ndirection = [0, 0, 1]\nkey = [0.5, 0.5, 0.5]\nambient = [0.2, 0.3, 0.4]");
  const Lighting fixed = fixedLighting(dim, glm::dmat3(1.0));
  EXPECT_NEAR(fixed.white.g, 0.2140 + 0.0732, 1e-3);
  EXPECT_GT(shadeTint(fixed).b, shadeTint(fixed).r) << "shade has the ambient light's hue";
}

TEST(Lighting, ADirectionOfTheCamerasStaysWithTheCamera) {
  Light read = light("direction = [0, 0, 1]\nframe = \"camera\"");
  // A tag that lies on its back in front of the camera: its z points up, the camera's −y.
  const glm::dmat3 cameraFromAttach(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, -1, 0));
  const Lighting there = withSceneDirection({}, read, cameraFromAttach);
  const Lighting seen = turned(glm::mat3(cameraFromAttach), there);
  EXPECT_LT(glm::distance(seen.towardKey, glm::vec3(0.0F, 0.0F, -1.0F)), 1e-6F);
  EXPECT_LT(glm::distance(seen.up, glm::vec3(0.0F, -1.0F, 0.0F)), 1e-6F);
}

}  // namespace
}  // namespace pleinair::scene
