// Reads real models, and the broken ones of the validator's own tests.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "pipeline/scene/gltf/gltf_file.h"
#include "pipeline/scene/models/model_pose.h"

namespace pleinair::scene {
namespace {

const std::filesystem::path kData = PLEINAIR_SHARED_DATA;

/// Whether the validator found no error and no unsupported extension is required.
bool mustLoad(const std::filesystem::path& file) {
  const auto report = nlohmann::json::parse(std::ifstream(file.string() + ".report.json"));
  return report.at("issues").at("numErrors") == 0 &&
         !report.value("info", nlohmann::json::object()).contains("extensionsRequired");
}

TEST(MalformedGltf, LoadsWhatIsSoundAndRefusesTheRestInALine) {
  if (!std::filesystem::exists(kData / "malformed/gltf")) GTEST_SKIP() << "no real test data";
  int sound = 0;
  int broken = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(kData / "malformed/gltf")) {
    const std::filesystem::path& file = entry.path();
    if (!std::filesystem::exists(file.string() + ".report.json")) continue;
    SCOPED_TRACE(file.string());
    const hal::Result<Model> model = readGltf(file);
    if (mustLoad(file)) {
      ++sound;
      EXPECT_TRUE(model) << model.error().message();
    }
    if (model) {
      ModelPose pose;
      poseModel(*model, std::nullopt, hal::Duration::zero(), pose);
      EXPECT_TRUE(std::isfinite(boundingSphere(*model, pose).radiusMetres));
    } else if (!mustLoad(file)) {
      ++broken;
      const std::string message = model.error().message();
      EXPECT_THAT(message, testing::StartsWith(file.string() + ": "));
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
  EXPECT_EQ(sound, 14);  // check that the files were found
  EXPECT_GE(broken, 28);
}

struct RealModel {
  std::string file;
  std::size_t parts;
  std::uint32_t triangles;
  std::size_t materials;
  std::size_t textures;
  glm::dvec3 low;  ///< bounds of its vertices, computed independently; in our frame
  glm::dvec3 high;
};

struct Box {
  glm::dvec3 low{1e9};
  glm::dvec3 high{-1e9};
};

/// At rest.
Box boxOf(const Model& model) {
  ModelPose pose;
  poseModel(model, std::nullopt, hal::Duration::zero(), pose);
  Box box;
  for (const ModelPart& part : model.parts) {
    for (std::size_t i = 0; i < part.surfaceCount; ++i) {
      const std::size_t count = model.surfaces[part.firstSurface + i].mesh.vertices.size();
      for (std::size_t vertex = 0; vertex < count; ++vertex) {
        const glm::dvec3 p(posedVertex(model, part, i, vertex, pose).position);
        box.low = glm::min(box.low, p);
        box.high = glm::max(box.high, p);
      }
    }
  }
  return box;
}

class RealGltf : public testing::TestWithParam<RealModel> {};

TEST_P(RealGltf, Loads) {
  const RealModel& expected = GetParam();
  if (!std::filesystem::exists(kData / "models")) GTEST_SKIP() << "no real test data";
  const hal::Result<Model> model = readGltf(kData / "models" / expected.file);
  ASSERT_TRUE(model) << model.error().message();
  EXPECT_EQ(model->parts.size(), expected.parts);
  EXPECT_EQ(model->triangleCount(), expected.triangles);
  EXPECT_EQ(model->materials.size(), expected.materials);
  EXPECT_EQ(model->textures.size(), expected.textures);
  const Box box = boxOf(*model);
  const double size = glm::distance(expected.low, expected.high);
  EXPECT_LT(glm::distance(box.low, expected.low), 0.01 * size);
  EXPECT_LT(glm::distance(box.high, expected.high), 0.01 * size);
  const BoundingSphere sphere = boundingSphere(*model);
  EXPECT_GE(sphere.radiusMetres, 0.3 * size);
  EXPECT_LE(sphere.radiusMetres, 1.5 * size);
  for (const ModelPart& part : model->parts) EXPECT_FALSE(part.name.empty());
}

INSTANTIATE_TEST_SUITE_P(
    All, RealGltf,
    testing::Values(
        // 11160 of its 121496 triangles have no area
        RealModel{"2CylinderEngine.glb",
                  67,
                  110336,
                  34,
                  0,
                  {-371.692, -128.0, -180.972},
                  {371.692, 140.0, 92.042}},
        RealModel{"BoxAnimated.glb", 2, 254, 2, 0, glm::dvec3(-0.5), glm::dvec3(0.5)},
        RealModel{"BoxTextured.glb", 1, 12, 1, 1, glm::dvec3(-0.5), glm::dvec3(0.5)},
        RealModel{"Fox.glb", 1, 576, 1, 1, {-12.593, -66.625, -0.122}, {12.593, 88.095, 78.907}},
        RealModel{"RiggedFigure.glb", 1, 256, 1, 0, {-0.589, -0.195, 0.0}, {0.589, 0.131, 1.45}},
        RealModel{"greenman.glb", 1, 356, 1, 1, {-1.36, -0.726, -0.042}, {1.36, 0.723, 1.99}},
        // 4 of its 3238 triangles have no area
        RealModel{"robot.glb", 14, 3234, 3, 0, {-3.312, -1.308, -0.02}, {3.309, 1.308, 4.539}}),
    [](const auto& instance) {
      std::string name = instance.param.file.substr(0, instance.param.file.find('.'));
      return name == "2CylinderEngine" ? "Engine" : name;
    });

}  // namespace
}  // namespace pleinair::scene
