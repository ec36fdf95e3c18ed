#include <string>

#include <gtest/gtest.h>

#include "config/config_error.h"
#include "pipeline/scene/description/scene_file.h"
#include "pipeline/scene/description/scene_tables.h"

namespace pleinair::scene {
namespace {

const std::string kTag = "[[tag]]\nid = 0\nedge_m = 0.12\nposition_m = [0, 0, 0]\n";

std::string errorOf(const std::string& text) {
  try {
    parseScene(text, "scene.toml", {});
  } catch (const config::ConfigError& error) {
    return error.what();
  }
  return "(nothing thrown)";
}

TEST(ScenePlanes, AreRead) {
  const Scene scene = parseScene(kTag +
                                     "[[plane]]\nattach = \"tag:0\"\nsize_m = [1.5, 0.5]\n"
                                     "[[plane]]\nname = \"wall\"\nattach = \"world\"\n"
                                     "size_m = [2, 1]\nposition_m = [0, 0.4, 0.3]\n"
                                     "rotation_deg = [90, 0, 0]\n",
                                 "scene.toml", {});
  ASSERT_EQ(scene.planes.size(), 2u);
  EXPECT_EQ(scene.planes[0].name, "plane 1");
  EXPECT_EQ(scene.planes[0].tagId, 0);
  EXPECT_EQ(scene.planes[0].sizeMetres, glm::dvec2(1.5, 0.5));
  EXPECT_EQ(scene.planes[0].attachFromPlane, glm::dmat4(1.0));
  EXPECT_EQ(scene.planes[1].name, "wall");
  EXPECT_EQ(scene.planes[1].tagId, std::nullopt);
  const glm::dvec4 normal = scene.planes[1].attachFromPlane * glm::dvec4(0.0, 0.0, 1.0, 0.0);
  EXPECT_NEAR(normal.y, -1.0, 1e-12);
}

TEST(ScenePlanes, MistakesAreNamed) {
  const std::string plane = kTag + "[[plane]]\nattach = \"tag:0\"\n";
  EXPECT_EQ(errorOf(plane),
            "scene.toml:5: plane[0].size_m: missing, allowed: an array of 2 numbers "
            "of metres in (0, 1000]");
  EXPECT_EQ(errorOf(plane + "size_m = [1, 0]\n"),
            "scene.toml:7: plane[0].size_m[1]: found 0, allowed: a number of metres in (0, 1000]");
  EXPECT_EQ(errorOf(kTag + "[[plane]]\nattach = \"tag:1\"\nsize_m = [1, 1]\n"),
            "scene.toml:6: plane[0].attach: found \"tag:1\", allowed: \"world\", \"tag:0\"");
  EXPECT_EQ(
      errorOf(plane + "size_m = [1, 1]\nname = \"a\"\n" + "[[plane]]\nattach = \"world\"\n" +
              "size_m = [1, 1]\nname = \"a\"\n"),
      "scene.toml:12: plane[1].name: \"a\" is used by an earlier plane, allowed: unique names");
  std::string many = kTag;
  for (int i = 0; i < 9; ++i) many += "[[plane]]\nattach = \"world\"\nsize_m = [1, 1]\n";
  EXPECT_EQ(errorOf(many), "scene.toml:5: plane: found 9 planes, allowed: at most 8");
}

TEST(SceneFoci, AreRead) {
  const Scene scene = parseScene(kTag +
                                     "[[focus]]\nattach = \"tag:0\"\nposition_m = [0, 0.1, 0.2]\n"
                                     "radius_m = 0.25\n"
                                     "[[focus]]\nattach = \"world\"\nradius_m = 1\n"
                                     "falloff_m = 0.5\nstrength = 0.6\n",
                                 "scene.toml", {});
  ASSERT_EQ(scene.foci.size(), 2U);
  EXPECT_EQ(scene.foci[0].tagId, 0);
  EXPECT_EQ(scene.foci[0].attachFromCentre, glm::dvec3(0.0, 0.1, 0.2));
  EXPECT_EQ(scene.foci[0].radiusMetres, 0.25);
  EXPECT_EQ(scene.foci[0].falloffMetres, 0.25) << "as much as the radius";
  EXPECT_EQ(scene.foci[0].strength, 1.0);
  EXPECT_EQ(scene.foci[1].tagId, std::nullopt);
  EXPECT_EQ(scene.foci[1].attachFromCentre, glm::dvec3(0.0));
  EXPECT_EQ(scene.foci[1].falloffMetres, 0.5);
  EXPECT_EQ(scene.foci[1].strength, 0.6);
}

TEST(SceneFoci, MistakesAreNamed) {
  const std::string focus = kTag + "[[focus]]\nattach = \"tag:0\"\n";
  EXPECT_EQ(errorOf(focus),
            "scene.toml:5: focus[0].radius_m: missing, allowed: a number of metres in (0, 1000]");
  EXPECT_EQ(errorOf(focus + "radius_m = 0\n"),
            "scene.toml:7: focus[0].radius_m: found 0, allowed: a number of metres in (0, 1000]");
  EXPECT_EQ(errorOf(focus + "radius_m = 1\nstrength = 2\n"),
            "scene.toml:8: focus[0].strength: found 2, allowed: a number in [0, 1]");
  EXPECT_EQ(errorOf(kTag + "[[focus]]\nattach = \"tag:1\"\nradius_m = 1\n"),
            "scene.toml:6: focus[0].attach: found \"tag:1\", allowed: \"world\", \"tag:0\"");
  EXPECT_NE(errorOf(focus + "radius_m = 1\nradius_mm = 1\n"), "(nothing thrown)");
  std::string many = kTag;
  for (int i = 0; i < 4; ++i) many += "[[focus]]\nattach = \"world\"\nradius_m = 1\n";
  EXPECT_EQ(errorOf(many), "scene.toml:5: focus: found 4 foci, allowed: at most 3");
}

TEST(SceneOccluders, AreRead) {
  const Scene scene =
      parseScene(kTag +
                     "[[model]]\nsource = \"builtin:box\"\nattach = \"tag:0\"\noccluder = true\n"
                     "[[model]]\nsource = \"builtin:box\"\nattach = \"tag:0\"\n",
                 "scene.toml", {});
  EXPECT_TRUE(scene.models[0].isOccluder);
  EXPECT_FALSE(scene.models[1].isOccluder);
}

}  // namespace
}  // namespace pleinair::scene
