#include "pipeline/scene/description/scene_file.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "config/config_error.h"
#include "pipeline/scene/description/scene.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::scene {
namespace {

Scene parsed(const std::string& text) {
  return parseScene(text, "scene.toml", {});
}

std::string errorOf(const std::string& text) {
  try {
    parsed(text);
  } catch (const config::ConfigError& error) {
    return error.what();
  }
  return "(nothing thrown)";
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_LT(glm::distance(a, b), 1e-12) << a.x << ' ' << a.y << ' ' << a.z;
}

const std::string kTag = "[[tag]]\nid = 0\nedge_m = 0.12\nposition_m = [0, 0, 0]\n";
const std::string kGear =
    "[[model]]\nname = \"gear\"\nsource = \"builtin:gear\"\nattach = \"tag:0\"\n";

TEST(SceneFile, MayBeEmpty) {
  const Scene scene = parsed("");
  EXPECT_FALSE(scene.camera);
  EXPECT_TRUE(scene.tags.empty());
  EXPECT_TRUE(scene.models.empty());
  EXPECT_EQ(scene.tagFamily, "tag36h11");
  EXPECT_NEAR(glm::length(scene.light.towardLight), 1.0, 1e-8);
}

TEST(SceneFile, ReadsEverything) {
  const Scene scene = parsed(R"(
[light]
direction = [0, 0, 2]
frame = "attached"
[[tag]]
family = "tag36h11"
id = 7
edge_m = 0.05
[[tag]]
id = 3
edge_m = 1
position_m = [1, 2, 3]
[[model]]
name = "wheel"
source = "builtin:gear"
attach = "tag:7"
position_m = [0.1, 0.2, 0.3]
rotation_deg = [0, 0, 90]
scale = 2
colour = "#ff8000"
focus = 0.5
teeth = 24
module_m = 0.004
thickness_m = 0.02
pressure_angle_deg = 14.5
bore_diameter_m = 0.02
hub_diameter_m = 0.04
holes = 4
[[model]]
source = "builtin:box"
attach = "world"
size_m = [1, 2, 3]
colour = [0.25, 0.5, 1]
)");
  EXPECT_EQ(scene.light.frame, Light::Frame::kAttached);
  expectNear(scene.light.towardLight, {0, 0, 1});
  ASSERT_EQ(scene.tags.size(), 2u);
  EXPECT_EQ(scene.findTag(7)->edgeMetres, 0.05);
  EXPECT_FALSE(scene.findTag(7)->worldFromTag);
  EXPECT_EQ(scene.findTag(8), nullptr);
  ASSERT_EQ(scene.models.size(), 2u);
  const SceneModel& wheel = scene.models[0];
  EXPECT_EQ(wheel.name, "wheel");
  EXPECT_EQ(wheel.tagId, 7);
  EXPECT_EQ(wheel.srgb, glm::vec3(1.0F, 128.0F / 255.0F, 0.0F));
  EXPECT_EQ(wheel.focus, 0.5F);
  // scaled, rotated to the left, translated
  expectNear(wheel.attachFromModel * glm::dvec4(1, 0, 0, 1), {0.1, 2.2, 0.3});
  const auto& gear = std::get<GearSource>(wheel.source);
  EXPECT_EQ(gear.form.teeth, 24);
  EXPECT_EQ(gear.form.moduleMetres, 0.004);
  EXPECT_NEAR(gear.form.pressureAngleRad, 0.25307, 1e-5);
  EXPECT_EQ(gear.thicknessMetres, 0.02);
  EXPECT_EQ(gear.boreDiameterMetres, 0.02);
  EXPECT_EQ(gear.hubDiameterMetres, 0.04);
  EXPECT_EQ(gear.holes, 4);
  const SceneModel& box = scene.models[1];
  EXPECT_EQ(box.name, "model 2");
  EXPECT_FALSE(box.tagId);
  EXPECT_EQ(std::get<BoxSource>(box.source).sizeMetres, glm::dvec3(1, 2, 3));
  EXPECT_EQ(box.srgb, glm::vec3(0.25F, 0.5F, 1.0F));
  EXPECT_EQ(box.model->triangleCount(), 12u);
}

constexpr const char* kInlineCamera =
    "[camera]\nimage_size = [640, 480]\nfx = 500\nfy = 501\ncx = 320\ncy = 240\n";

TEST(SceneFile, TakesACalibrationInPlace) {
  const Scene scene = parsed(kInlineCamera);
  ASSERT_TRUE(scene.camera);
  EXPECT_EQ(scene.camera->intrinsics().fy, 501.0);
  EXPECT_EQ(errorOf(std::string(kInlineCamera) + "zoom = 2\n").find("scene.toml:7: camera.zoom: "),
            0u);
}

TEST(SceneFile, FindsACalibrationBesideItself) {
  const std::filesystem::path directory = testing::TempDir() + "pleinair_scene_file_test";
  std::filesystem::create_directories(directory);
  std::ofstream(directory / "camera.toml")
      << std::string(kInlineCamera).substr(std::string("[camera]\n").size())
      << "distortion = [-0.2, 0, 0, 0]\n";
  std::ofstream(directory / "scene.toml") << "[camera]\ncalibration = \"camera.toml\"\n" + kTag +
                                                 "[[model]]\nsource = \"builtin:box\"\n"
                                                 "attach = \"world\"\n";
  const Scene scene = loadScene(directory / "scene.toml");
  ASSERT_TRUE(scene.camera);
  EXPECT_EQ(scene.camera->distortion().k1, -0.2);
  // a lens that bends lines needs shorter edges
  EXPECT_GT(scene.models[0].model->triangleCount(), 500u);
  std::filesystem::remove(directory / "camera.toml");
  try {
    loadScene(directory / "scene.toml");
    FAIL() << "nothing thrown";
  } catch (const config::ConfigError& error) {
    EXPECT_EQ(error.file(), (directory / "scene.toml").string());  // it names a wrong file
    EXPECT_NE(std::string(error.what()).find("camera.toml"), std::string::npos) << error.what();
  }
  std::filesystem::remove_all(directory);
}

TEST(SceneFile, PlacesTagsByTheirAuthorsFrame) {
  const Scene scene =
      parsed("[[tag]]\nid = 0\nedge_m = 1\nposition_m = [1, 2, 3]\nrotation_deg = [90, 0, 0]\n");
  const glm::dmat4 worldFromTag = *scene.tags[0].worldFromTag;
  // after a rotation by 90° about x, the tag's top (−y of tracking's frame) points up, and its face
  // (−z of tracking's frame) to −y
  expectNear(worldFromTag * glm::dvec4(0, -1, 0, 0), {0, 0, 1});
  expectNear(worldFromTag * glm::dvec4(0, 0, -1, 0), {0, -1, 0});
  expectNear(worldFromTag * glm::dvec4(0, 0, 0, 1), {1, 2, 3});
}

TEST(SceneFile, TurnsAboutFixedAxesXThenYThenZ) {
  const Scene scene = parsed(kTag + kGear + "rotation_deg = [90, 90, 0]\n");
  // x turns (0, 1, 0) to z, then y turns z to x
  expectNear(scene.models[0].attachFromModel * glm::dvec4(0, 1, 0, 0), {1, 0, 0});
}

TEST(SceneFile, SharesTheMeshesOfEqualModels) {
  const Scene scene = parsed(kTag + kGear + "[[model]]\nsource = \"builtin:gear\"\n" +
                             "attach = \"tag:0\"\n[[model]]\nsource = \"builtin:gear\"\n" +
                             "attach = \"tag:0\"\nteeth = 19\n");
  EXPECT_EQ(scene.models[0].model, scene.models[1].model);
  EXPECT_NE(scene.models[0].model, scene.models[2].model);
}

TEST(SceneFile, FindsModelsBesideItself) {
  const std::filesystem::path directory = testing::TempDir() + "pleinair_scene_model_test";
  std::filesystem::create_directories(directory / "parts");
  std::ofstream(directory / "parts/empty.GLTF") << R"({"asset":{"version":"2.0"}})";
  const auto sceneWith = [&](const std::string& source) {
    return parseScene(kTag + "[[model]]\nsource = \"" + source + "\"\nattach = \"tag:0\"\n",
                      "scene.toml", directory);
  };
  const Scene scene = sceneWith("parts/empty.GLTF");
  EXPECT_EQ(scene.models[0].srgb, glm::vec3(1.0F));  // files have their own colours
  ASSERT_EQ(scene.notices.size(), 1u);
  EXPECT_EQ(scene.notices[0],
            (directory / "parts/empty.GLTF").string() + ": it contains nothing visible");
  try {
    sceneWith("gone.glb");
    FAIL() << "nothing thrown";
  } catch (const config::ConfigError& error) {
    EXPECT_EQ(std::string(error.what())
                  .find("scene.toml:6: model[0].source: " + (directory / "gone.glb").string()),
              0u)
        << error.what();
  }
  std::filesystem::remove_all(directory);
}

TEST(SceneFile, ReadsAGearbox) {
  const Scene scene = parsed(kTag + R"(
[[model]]
source = "builtin:gearbox"
attach = "tag:0"
length_m = 0.5
speed_rpm = -20.5
stage_1 = [20, 40]
stage_2 = [16, 60]
cover = "closed"
)");
  const auto& gearbox = std::get<GearboxSource>(scene.models[0].source);
  EXPECT_EQ(gearbox, (GearboxSource{.lengthMetres = 0.5,
                                    .inputRevolutions = -20.5,
                                    .stage1 = {20, 40},
                                    .stage2 = {16, 60},
                                    .isClosed = true}));
  EXPECT_EQ(scene.models[0].srgb, glm::vec3(1.0F));
  EXPECT_GT(scene.models[0].model->parts.size(), 60u);
}

struct Mistake {
  std::string text;
  std::string message;
  friend std::ostream& operator<<(std::ostream& out, const Mistake& each) {
    return out << each.message;
  }
};

class SceneFileMistake : public testing::TestWithParam<Mistake> {};

TEST_P(SceneFileMistake, IsNamed) {
  EXPECT_EQ(errorOf(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    All, SceneFileMistake,
    testing::Values(
        Mistake{"[[tag]]\nid = 0\n",
                "scene.toml:1: tag[0].edge_m: missing, allowed: a number of metres in [0.002, 3]"},
        Mistake{"[[tag]]\nid = 0\nedge_m = 0\n",
                "scene.toml:3: tag[0].edge_m: found 0, allowed: a number of metres in [0.002, 3]"},
        Mistake{"[[tag]]\nid = 0\nedge_m = 12\n",
                "scene.toml:3: tag[0].edge_m: found 12 metres; 12 mm are 0.012 m, 12 cm are 0.12 "
                "m, allowed: a number of metres in [0.002, 3]"},
        Mistake{"[[tag]]\nid = 0\nedge_mm = 60\n",
                "scene.toml:3: tag[0].edge_mm: is no key: lengths are in metres, allowed: edge_m "
                "(60 mm are 0.06)"},
        Mistake{"[[tag]]\nid = 0\nedge = 0.06\n",
                "scene.toml:3: tag[0].edge: is no key: lengths are in metres, allowed: edge_m (60 "
                "mm are 0.06)"},
        Mistake{kTag + "[[plane]]\nattach = \"tag:0\"\nsize_cm = [20, 20]\n",
                "scene.toml:7: plane[0].size_cm: is no key: lengths are in metres, allowed: size_m "
                "(60 mm are 0.06)"},
        Mistake{"[[tag]]\nid = 587\nedge_m = 1\n",
                "scene.toml:2: tag[0].id: found 587, allowed: a whole number in [0, 586]"},
        Mistake{kTag + kTag,
                "scene.toml:6: tag[1].id: 0 is used by an earlier tag, allowed: unique ids"},
        Mistake{kTag + "[[tag]]\nfamily = \"tag25h9\"\nid = 1\nedge_m = 1\n",
                "scene.toml:6: tag[1].family: found \"tag25h9\", allowed: one family a scene, and "
                "tag[0] has \"tag36h11\""},
        Mistake{
            kTag + "[[model]]\nsource = \"builtin:gera\"\nattach = \"tag:0\"\n",
            "scene.toml:6: model[0].source: found \"builtin:gera\", allowed: "
            "builtin:box, builtin:gear, builtin:gearbox, builtin:tube, builtin:ball, or a .glb, "
            ".gltf, .stl or .obj file"},
        Mistake{kTag + "[[model]]\nsource = \"builtin:box\"\nattach = \"tag:1\"\n",
                "scene.toml:7: model[0].attach: found \"tag:1\", allowed: \"world\", \"tag:0\""},
        Mistake{"[[model]]\nsource = \"builtin:box\"\nattach = \"tag:1\"\n",
                "scene.toml:3: model[0].attach: found \"tag:1\", allowed: the scene's tags, but it "
                "has no [[tag]]"},
        Mistake{"[[tag]]\nid = 0\nedge_m = 1\n[[model]]\nsource = \"builtin:box\"\n"
                "attach = \"world\"\n",
                "scene.toml:6: model[0].attach: no tag locates the world, allowed: "
                "\"world\" once a [[tag]] has a position_m"},
        Mistake{kTag + kGear + "colour = \"#12345\"\n",
                "scene.toml:9: model[0].colour: found \"#12345\", allowed: \"#rrggbb\" or an array "
                "of 3 numbers in [0, 1]"},
        Mistake{kTag + kGear + "colour = \"#12-456\"\n",
                "scene.toml:9: model[0].colour: found \"#12-456\", allowed: \"#rrggbb\" or an "
                "array of 3 numbers in [0, 1]"},
        Mistake{kTag + kGear + "colour = [0, 1, 2]\n",
                "scene.toml:9: model[0].colour[2]: found 2, allowed: a number in [0, 1]"},
        Mistake{kTag + kGear + "size_m = [1, 1, 1]\n",
                "scene.toml:9: model[0].size_m: unknown key, allowed: name, source, teeth, "
                "module_m, pressure_angle_deg, thickness_m, bore_diameter_m, hub_diameter_m, "
                "holes, attach, scale, position_m, rotation_deg, colour, occluder, focus, clip, "
                "speed, loop, start"},
        Mistake{kTag + kGear + "teeth = 5\n",
                "scene.toml:9: model[0].teeth: found 5, allowed: a whole number in [6, 200]"},
        Mistake{kTag + "[[model]]\nsource = \"builtin:gearbox\"\nattach = \"tag:0\"\n"
                       "stage_2 = [18, 61]\n",
                "scene.toml:8: model[0].stage_2: found [18, 61], allowed: teeth of a pinion, 16 to "
                "30, and of a wheel, 36 to 60"},
        Mistake{kTag + kGear + "bore_diameter_m = 0.08\n",
                "scene.toml:9: model[0].bore_diameter_m: found 0.08, too wide for the teeth, "
                "allowed: at most 0.07 here"},
        Mistake{kTag + kGear + kGear,
                "scene.toml:10: model[1].name: \"gear\" is used by an earlier model, allowed: "
                "unique names"},
        Mistake{kTag + kGear + "rotation_deg = [1, 2]\n",
                "scene.toml:9: model[0].rotation_deg: found an array of 2, allowed: an array of 3 "
                "numbers of degrees in [-360, 360]"},
        Mistake{
            "[light]\ndirection = [0, 0, 0]\n",
            "scene.toml:2: light.direction: has no length, allowed: a vector towards the light"},
        Mistake{
            "[lamp]\n",
            "scene.toml:1: lamp: unknown key, allowed: camera, light, tag, plane, focus, model"}));

TEST(SceneFileMistakes, NameEveryTagFamilyThereIs) {
  const std::string message = errorOf("[[tag]]\nfamily = \"36h11\"\nid = 0\nedge_m = 1\n");
  EXPECT_EQ(message.find("scene.toml:2: tag[0].family: unknown tag family"), 0u) << message;
  EXPECT_NE(message.find("tag36h11, "), std::string::npos) << message;
}

TEST(SceneFileMistakes, CountModels) {
  std::string text = kTag;
  const std::string box = "[[model]]\nsource = \"builtin:box\"\nattach = \"tag:0\"\n";
  for (int i = 0; i < 510; ++i) text += box;
  EXPECT_EQ(parsed(text).models.size(), 510u);
  EXPECT_EQ(errorOf(text + box), "scene.toml:5: model: found 511 models, allowed: at most 510");
}

TEST(SceneFileMistakes, CountTriangles) {
  std::string text = kTag;
  for (int i = 0; i < 100; ++i) {
    text +=
        "[[model]]\nsource = \"builtin:gear\"\nattach = \"tag:0\"\nteeth = 200\nthickness_m = 0." +
        std::to_string(10 + i) + "\n";
  }
  EXPECT_NE(errorOf(text).find("triangles in the scene, allowed: at most 1000000 in all"),
            std::string::npos)
      << errorOf(text);
}

TEST(SceneFileMistakes, CountTrianglesThatALensHasCutSmall) {
  const support::TemporaryFolder folder;
  std::string model = R"({"asset":{"version":"2.0"},
    "buffers":[{"byteLength":36,"uri":"data:;base64,)"
                      "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"
                      R"("}],
    "bufferViews":[{"buffer":0,"byteLength":36}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
    "nodes":[{"mesh":0})";
  for (int i = 1; i < 17'000; ++i) model += R"(,{"mesh":0})";
  std::ofstream(folder.path() / "many.gltf") << model + "]}";
  const std::string text = kTag + "[[model]]\nsource = \"many.gltf\"\nattach = \"tag:0\"\n";
  EXPECT_EQ(parseScene(text, "scene.toml", folder.path()).models[0].model->triangleCount(),
            17'000u);
  const std::string lens =
      "[camera]\nimage_size = [640, 480]\nfx = 500\nfy = 500\ncx = 320\ncy = 240\n"
      "distortion = [0.1]\n";
  try {
    parseScene(lens + text, "scene.toml", folder.path());
    FAIL() << "nothing thrown";
  } catch (const config::ConfigError& error) {
    EXPECT_NE(
        std::string(error.what()).find("triangles, cut small for the lens, allowed: at most "),
        std::string::npos)
        << error.what();
  }
}

TEST(SceneFileMistakes, SayThatTheFileIsMissing) {
  try {
    loadScene("/nonexistent/scene.toml");
    FAIL() << "nothing thrown";
  } catch (const config::ConfigError& error) {
    EXPECT_EQ(error.file(), "/nonexistent/scene.toml");
  }
}

TEST(AttachFrame, IsTrackingsTagFrameTurnedOver) {
  EXPECT_EQ(kAttachFromTag * kTagFromAttach, glm::dmat4(1.0));
  EXPECT_EQ(kTagFromAttach * glm::dvec4(1, 2, 3, 1), glm::dvec4(1, -2, -3, 1));
}

TEST(AssumedCamera, SeesSixtyDegrees) {
  const tracking::CameraModel camera = assumedCamera({640, 480});
  const double edge = std::tan(3.14159265358979 / 6.0);
  EXPECT_NEAR(camera.project({edge, 0.0, 1.0}).x, 640.0, 1e-9);
  EXPECT_NEAR(camera.project({-edge, 0.0, 1.0}).x, 0.0, 1e-9);
  EXPECT_NEAR(camera.project({0.0, 0.0, 1.0}).y, 240.0, 1e-9);
}

TEST(FittedCamera, FollowsAspectFill) {
  const tracking::CameraModel camera({.fx = 1000, .fy = 1000, .cx = 640, .cy = 360}, {.k1 = -0.1},
                                     {1280, 720});
  // 640×480 is covered by the central 960×720 of the frame, at a scale of 2/3
  const tracking::CameraModel fitted = fittedCamera(camera, {640, 480});
  EXPECT_EQ(fitted.imageSize(), (hal::FrameSize{640, 480}));
  const glm::dvec3 p(0.1, -0.2, 1.3);
  const glm::dvec2 before = camera.project(p);
  const glm::dvec2 after = fitted.project(p);
  EXPECT_NEAR(after.x, (before.x - 160.0) / 1.5, 1e-9);
  EXPECT_NEAR(after.y, before.y / 1.5, 1e-9);
}

}  // namespace
}  // namespace pleinair::scene
