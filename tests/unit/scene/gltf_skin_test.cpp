// Skins: joint weights of vertices, and the resulting positions.
#include <cmath>
#include <functional>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "pipeline/scene/gltf/gltf_file.h"
#include "pipeline/scene/models/model_pose.h"
#include "tests/unit/scene/gltf_builder.h"

namespace pleinair::scene {
namespace {

using nlohmann::json;

const std::vector<float> kTriangle{0, 0, 0, 1, 0, 0, 0, 1, 0};

Model parsed(const GltfBuilder& builder) {
  hal::Result<Model> model = parseGltf(builder.bytes(), "test.glb");
  if (!model) throw std::runtime_error(model.error().message());
  return *std::move(model);
}

std::string refusalOf(const GltfBuilder& builder) {
  const hal::Result<Model> model = parseGltf(builder.bytes(), "m.glb");
  return model ? "(was taken)" : model.error().message();
}

/// `count` matrices; each translates by its vector.
std::vector<float> movingMatrices(const std::vector<glm::vec3>& moves) {
  std::vector<float> values;
  for (const glm::vec3& move : moves) {
    values.insert(values.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, move.x, move.y, move.z, 1});
  }
  return values;
}

/// A triangle on two bones, the second a child of the first: corner 0 follows the first bone,
/// corner 1 both equally, corner 2 the second. Nodes: 0 shows the triangle, 1 and 2 are the bones.
GltfBuilder twoBones() {
  GltfBuilder builder;
  auto& primitive = builder.addMesh(kTriangle, "figure");
  primitive["attributes"]["JOINTS_0"] =
      builder.addAccessor<std::uint8_t>({0, 9, 9, 9, 0, 1, 9, 9, 1, 9, 9, 9}, "VEC4", 5121, 4);
  primitive["attributes"]["WEIGHTS_0"] =
      builder.addFloats({1, 0, 0, 0, 0.5, 0.5, 0, 0, 2, 0, 0, 0}, "VEC4", 4);
  builder.root["nodes"][0]["skin"] = 0;
  builder.root["nodes"][0]["translation"] = {100, 100, 100};  // is ignored
  builder.root["nodes"].push_back({{"translation", {0, 0, 3}}, {"children", {2}}});
  builder.root["nodes"].push_back({{"translation", {0, 4, 0}}});
  // the second joint was bound at y = 1
  const int inverse = builder.addFloats(movingMatrices({{0, 0, 0}, {0, -1, 0}}), "MAT4", 16);
  builder.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", inverse}}};
  return builder;
}

/// A posed vertex of a part's first surface.
MeshVertex vertexOf(const Model& model, std::size_t vertex,
                    const std::optional<ClipMoment>& moment = std::nullopt, std::size_t part = 0) {
  ModelPose pose;
  poseModel(model, moment, hal::Duration::zero(), pose);
  return posedVertex(model, model.parts[part], 0, vertex, pose);
}

void expectNear(const glm::vec3& a, const glm::vec3& b) {
  EXPECT_LT(glm::distance(a, b), 1e-6F) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(Skin, PutsVerticesWhereItsJointsAre) {
  const Model model = parsed(twoBones());
  // joint 0 moves by (0, 0, 3), joint 1 by (0, 3, 3); weights are normalised by their sum
  expectNear(vertexOf(model, 0).position, {0, -3, 0});
  expectNear(vertexOf(model, 1).position, {1, -3, 1.5});
  expectNear(vertexOf(model, 2).position, {0, -3, 4});
  const Mesh& mesh = model.surfaces[0].mesh;
  EXPECT_EQ(mesh.vertices[1].position, glm::vec3(1, 0, 0));  // as it was bound
  EXPECT_THAT(mesh.joints[1].weights, testing::ElementsAre(0.5F, 0.5F, 0.0F, 0.0F));
  EXPECT_THAT(mesh.joints[2].weights, testing::ElementsAre(1.0F, 0.0F, 0.0F, 0.0F));
  ASSERT_EQ(model.parts[0].skin, 0u);
  EXPECT_EQ(model.parts[0].matrixCount, 2u);
}

TEST(Skin, FollowsAClip) {
  GltfBuilder builder = twoBones();
  const auto half = static_cast<float>(std::sqrt(0.5));
  const int times = builder.addFloats({0, 2}, "SCALAR", 1);
  const int turns = builder.addFloats({0, 0, 0, 1, 0, 0, half, half}, "VEC4", 4);
  builder.root["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}}}},
       {"samplers", {{{"input", times}, {"output", turns}}}}}};
  const Model model = parsed(builder);
  ASSERT_EQ(model.rig.clips.size(), 1u);
  EXPECT_EQ(model.rig.clips[0].name, "animation 1");
  EXPECT_EQ(model.rig.clips[0].seconds, 2.0);
  const ClipMoment end{.clip = 0, .seconds = 2.0};
  // the second bone turns 90° about z at (0, 4, 3); the corner bound at its origin does not move
  expectNear(vertexOf(model, 0, end).position, {0, -3, 0});
  expectNear(vertexOf(model, 2, end).position, {0, -3, 4});
  // corner 1 is (1, -1, 0) from it: at (1, 5, 3), and by the first bone at (1, 0, 3)
  expectNear(vertexOf(model, 1, end).position, {1, -3, 2.5});
}

TEST(Skin, IsSharedByTheNodesThatShowAMeshWithIt) {
  GltfBuilder builder = twoBones();
  builder.root["nodes"].push_back({{"mesh", 0}, {"skin", 0}, {"translation", {7, 7, 7}}});
  builder.root["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 9}}});  // and once without
  const Model model = parsed(builder);
  ASSERT_EQ(model.parts.size(), 3u);
  EXPECT_EQ(model.surfaces.size(), 2u);
  EXPECT_EQ(model.parts[1].firstSurface, model.parts[0].firstSurface);
  EXPECT_EQ(model.rig.skins.size(), 1u);
  EXPECT_FALSE(model.parts[2].skin);
  EXPECT_TRUE(model.surfaces[model.parts[2].firstSurface].mesh.joints.empty());
  expectNear(vertexOf(model, 2, {}, 1).position, {0, -3, 4});
  expectNear(vertexOf(model, 2, {}, 2).position, {0, -9, 1});
}

TEST(Skin, KeepsTheStrongestFourJoints) {
  GltfBuilder builder = twoBones();
  auto& attributes = builder.root["meshes"][0]["primitives"][0]["attributes"];
  for (int i = 0; i < 4; ++i) builder.root["nodes"].push_back({{"translation", {i, 0, 0}}});
  builder.root["skins"][0] = {{"joints", {1, 2, 3, 4, 5, 6}}};
  attributes["JOINTS_0"] =
      builder.addAccessor<std::uint16_t>({0, 1, 2, 3, 0, 1, 2, 3, 5, 0, 0, 0}, "VEC4", 5123, 4);
  attributes["WEIGHTS_0"] = builder.addAccessor<std::uint8_t>(
      {25, 51, 76, 51, 64, 64, 64, 63, 255, 0, 0, 0}, "VEC4", 5121, 4, true);
  attributes["JOINTS_1"] =
      builder.addAccessor<std::uint16_t>({4, 5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 5123, 4);
  attributes["WEIGHTS_1"] = builder.addFloats({0.2F, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 4);
  const Model model = parsed(builder);
  EXPECT_THAT(
      model.notices,
      testing::ElementsAre("1 of its vertices are held by more than 4 joints; the strongest 4 do"));
  const JointWeights& held = model.surfaces[0].mesh.joints[0];
  EXPECT_THAT(held.joints, testing::UnorderedElementsAre(1, 2, 3, 4));
  float sum = 0.0F;
  for (std::size_t i = 0; i < 4; ++i) {
    sum += held.weights[i];
    const float given = held.joints[i] == 2 ? 76.0F : 51.0F;
    EXPECT_NEAR(held.weights[i], given / 229.0F, 1e-5F);
  }
  EXPECT_NEAR(sum, 1.0F, 1e-6F);
}

TEST(Skin, LetsTheFirstJointHoldWhatNoneDoes) {
  GltfBuilder builder = twoBones();
  auto& attributes = builder.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["WEIGHTS_0"] = builder.addFloats(std::vector<float>(12, 0.0F), "VEC4", 4);
  expectNear(vertexOf(parsed(builder), 1).position, {1, -3, 0});
  attributes.erase("WEIGHTS_0");
  attributes.erase("JOINTS_0");
  expectNear(vertexOf(parsed(builder), 1).position, {1, -3, 0});
}

TEST(Skin, TurnsNormalsAsItsSurfaceTurns) {
  GltfBuilder builder = twoBones();
  builder.root["nodes"][2]["scale"] = {1, 4, -1};  // mirrored: the outside stays outside
  builder.root["nodes"][1]["scale"] = {2, 1, 1};
  const Model model = parsed(builder);
  // flat in z: the normal along glTF's z, through the mirror
  expectNear(vertexOf(model, 0).normal, {0, -1, 0});
  expectNear(vertexOf(model, 2).normal, {0, 1, 0});
}

TEST(Skin, IsRefusedWhereItIsNone) {
  const auto spoilt = [](const std::function<void(GltfBuilder&)>& spoil) {
    GltfBuilder builder = twoBones();
    spoil(builder);
    return refusalOf(builder);
  };
  EXPECT_EQ(spoilt([](GltfBuilder&) {}), "(was taken)");
  EXPECT_EQ(spoilt([](GltfBuilder& b) {
              b.root["skins"][0]["joints"] = {1, 7};
            }),
            "m.glb: skins[0].joints[1]: there is no nodes[7]");
  EXPECT_EQ(spoilt([](GltfBuilder& b) { b.root["skins"][0]["joints"] = {1}; }),
            "m.glb: nodes[0].skin: meshes[0] is held by joint 1, of 1 of skins[0]");
  EXPECT_EQ(spoilt([](GltfBuilder& b) {
              b.root["skins"][0]["joints"] = {1, 2, 0};
            }),
            "m.glb: skins[0].inverseBindMatrices: has 2 of 3");
  EXPECT_EQ(spoilt([](GltfBuilder& b) { b.root["accessors"][0]["count"] = 2; }),
            "m.glb: meshes[0].primitives[0].attributes.JOINTS_0: has 3 elements, POSITION 2");
  EXPECT_EQ(spoilt([](GltfBuilder& b) {
              b.root["skins"][0].erase("inverseBindMatrices");
              b.root["skins"][0]["name"] = "Horde";
              json& joints = b.root["skins"][0]["joints"];
              while (joints.size() < 129) {
                joints.push_back(b.root["nodes"].size());
                b.root["nodes"].push_back(json::object());
              }
            }),
            "m.glb: skins[0].joints: the skin \"Horde\" has 129; at most 128 joints a skin");
}

TEST(Skin, IsNotPosedWithoutBounds) {
  GltfBuilder builder = twoBones();
  builder.root["skins"][0].erase("inverseBindMatrices");
  json& joints = builder.root["skins"][0]["joints"];
  while (joints.size() < 128) {
    joints.push_back(builder.root["nodes"].size());
    builder.root["nodes"].push_back(json::object());
  }
  for (int i = 0; i < 511; ++i) builder.root["nodes"].push_back({{"mesh", 0}, {"skin", 0}});
  EXPECT_EQ(refusalOf(builder), "(was taken)");
  builder.root["nodes"].push_back({{"mesh", 0}, {"skin", 0}});
  EXPECT_EQ(refusalOf(builder),
            "m.glb: nodes[640].skin: exceeds the total number of posed joints; at most 65536");
}

}  // namespace
}  // namespace pleinair::scene
