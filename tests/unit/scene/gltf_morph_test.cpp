// Morph targets: the vertices that they move, by themselves, with clips, and before skins.
#include <cmath>
#include <functional>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "pipeline/scene/gltf/gltf_file.h"
#include "pipeline/scene/models/model_pose.h"
#include "tests/oracles/gltf_oracle.h"
#include "tests/unit/scene/gltf_builder.h"

namespace pleinair::scene {
namespace {

using nlohmann::json;

const std::vector<float> kTriangle{0, 0, 0, 1, 0, 0, 0, 1, 0};
const std::vector<float> kForward{0, 0, 1, 0, 0, 1, 0, 0, 1};

Model parsed(const GltfBuilder& builder) {
  hal::Result<Model> model = parseGltf(builder.bytes(), "test.glb");
  if (!model) throw std::runtime_error(model.error().message());
  return *std::move(model);
}

/// A triangle that faces +z. The first target lifts corner 2 by 2 along z, the second moves all
/// corners by 1 along x. Accessors: 0 positions, 1 and 2 the targets', 3 the normals.
GltfBuilder morphing() {
  GltfBuilder builder;
  auto& primitive = builder.addMesh(kTriangle, "face");
  const int lift = builder.addFloats({0, 0, 0, 0, 0, 0, 0, 0, 2}, "VEC3", 3);
  const int shift = builder.addFloats({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3", 3);
  primitive["attributes"]["NORMAL"] = builder.addFloats(kForward, "VEC3", 3);
  primitive["targets"] = {{{"POSITION", lift}}, {{"POSITION", shift}}};
  return builder;
}

MeshVertex vertexOf(const Model& model, std::size_t vertex,
                    const std::optional<ClipMoment>& moment = std::nullopt, std::size_t part = 0) {
  ModelPose pose;
  poseModel(model, moment, hal::Duration::zero(), pose);
  return posedVertex(model, model.parts[part], 0, vertex, pose);
}

void expectNear(const glm::vec3& a, const glm::vec3& b) {
  EXPECT_LT(glm::distance(a, b), 1e-6F) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(Morph, StandsAsItsMeshOrItsNodeSays) {
  GltfBuilder builder = morphing();
  expectNear(vertexOf(parsed(builder), 2).position, {0, 0, 1});
  builder.root["meshes"][0]["weights"] = {0.5, 0};
  expectNear(vertexOf(parsed(builder), 2).position, {0, -1, 1});
  builder.root["nodes"][0]["weights"] = {0, 3};  // instead of the mesh's
  builder.root["nodes"].push_back({{"mesh", 0}});
  const Model model = parsed(builder);
  EXPECT_EQ(model.surfaces.size(), 1u);
  expectNear(vertexOf(model, 2).position, {3, 0, 1});
  expectNear(vertexOf(model, 2, {}, 1).position, {0, -1, 1});
  EXPECT_THAT(model.notices, testing::IsEmpty());
}

TEST(Morph, FollowsAClip) {
  GltfBuilder builder = morphing();
  builder.root["nodes"][0]["scale"] = {1, 1, 3};
  const int times = builder.addFloats({0, 1}, "SCALAR", 1);
  const int floats = builder.addFloats({0, 0, 1, -1}, "SCALAR", 1);
  const int bytes = builder.addAccessor<std::int8_t>({0, 0, 127, -127}, "SCALAR", 5120, 1, true);
  for (const int weights : {floats, bytes}) {
    builder.root["animations"] = {
        {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}},
         {"samplers", {{{"input", times}, {"output", weights}}}}}};
    const Model model = parsed(builder);
    expectNear(vertexOf(model, 2, ClipMoment{0, 0.5}).position, {-0.5, -3, 1});
    expectNear(vertexOf(model, 0, ClipMoment{0, 1.0}).position, {-1, 0, 0});
  }
}

TEST(Morph, MovesNormals) {
  GltfBuilder builder = morphing();
  const float half = std::sqrt(0.5F);
  const int turn = builder.addFloats({0, 0, 0, 0, 0, 0, 0, -half, half - 1}, "VEC3", 3);
  builder.root["meshes"][0]["primitives"][0]["targets"][0]["NORMAL"] = turn;
  builder.root["meshes"][0]["weights"] = {1, 0};
  const Model model = parsed(builder);
  expectNear(vertexOf(model, 2).normal, {0, -half, -half});
  expectNear(vertexOf(model, 0).normal, {0, -1, 0});
}

TEST(Morph, OfFlatShadingFacesAsTheMovedTriangleDoes) {
  GltfBuilder builder = morphing();
  builder.root["meshes"][0]["primitives"][0]["attributes"].erase("NORMAL");
  builder.root["meshes"][0]["weights"] = {1, 0};
  // (1,0,0) × (0,1,2) = (0,−2,1)
  const glm::vec3 expected = glm::normalize(glm::vec3(0, -1, -2));
  for (std::size_t i = 0; i < 3; ++i) expectNear(vertexOf(parsed(builder), i).normal, expected);
}

TEST(Morph, OpensTrianglesThatHaveNoAreaAtRest) {
  for (const bool hasNormals : {true, false}) {
    GltfBuilder builder = morphing();
    const int line = builder.addFloats({0, 0, 0, 1, 0, 0, 2, 0, 0}, "VEC3", 3);
    auto& attributes = builder.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["POSITION"] = line;
    if (!hasNormals) attributes.erase("NORMAL");
    const Model model = parsed(builder);
    ASSERT_EQ(model.triangleCount(), 1u);
    EXPECT_NEAR(glm::length(vertexOf(model, 0).normal), 1.0F, 1e-6F);
  }
}

TEST(Morph, TakesSparseTargets) {
  GltfBuilder builder = morphing();
  const std::vector<std::uint8_t> which{1};
  const std::vector<float> values{0, 5, 0};
  const int indices = builder.addView(which.data(), 1);
  const int replacement = builder.addView(values.data(), 12);
  builder.root["accessors"][1] = {{"componentType", 5126},
                                  {"count", 3},
                                  {"type", "VEC3"},
                                  {"sparse",
                                   {{"count", 1},
                                    {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                    {"values", {{"bufferView", replacement}}}}}};
  builder.root["meshes"][0]["weights"] = {1, 0};
  const Model model = parsed(builder);
  expectNear(vertexOf(model, 1).position, {1, 0, 5});
  expectNear(vertexOf(model, 2).position, {0, 0, 1});
}

/// Morph targets, a skin of two joints, splines of weights and of rotations, all at once.
GltfBuilder everything() {
  GltfBuilder builder = morphing();
  auto& attributes = builder.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] =
      builder.addAccessor<std::uint8_t>({0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC4", 5121, 4);
  attributes["WEIGHTS_0"] =
      builder.addFloats({1, 0, 0, 0, 0.25, 0.75, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
  builder.root["nodes"][0]["skin"] = 0;
  builder.root["nodes"].push_back({{"translation", {0, 0, 3}}, {"children", {2}}});
  builder.root["nodes"].push_back({{"translation", {0, 4, 0}}});
  builder.root["skins"] = {{{"joints", {1, 2}}}};
  const int times = builder.addFloats({0, 1, 3}, "SCALAR", 1);
  std::vector<float> weights;
  std::vector<float> turns;
  for (int i = 0; i < 18; ++i) weights.push_back(std::sin(static_cast<float>(3 * i)));
  for (int i = 0; i < 36; ++i) turns.push_back(std::cos(static_cast<float>(5 * i)));
  builder.root["animations"] = {
      {{"channels",
        {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}},
         {{"sampler", 1}, {"target", {{"node", 2}, {"path", "rotation"}}}}}},
       {"samplers",
        {{{"input", times},
          {"output", builder.addFloats(weights, "SCALAR", 1)},
          {"interpolation", "CUBICSPLINE"}},
         {{"input", times},
          {"output", builder.addFloats(turns, "VEC4", 4)},
          {"interpolation", "CUBICSPLINE"}}}}}};
  return builder;
}

TEST(Morph, ComesBeforeTheSkin) {
  const GltfBuilder builder = everything();
  const Model model = parsed(builder);
  const oracles::GltfOracle oracle(builder.bytes());
  ModelPose pose;
  for (double seconds = 0.0; seconds < 3.2; seconds += 0.1) {
    const auto expected = oracle.corners(0, 0, 0, seconds);
    poseModel(model, ClipMoment{0, seconds}, hal::Duration::zero(), pose);
    const BoundingSphere sphere = boundingSphere(model, pose);
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::vec3 position = posedVertex(model, model.parts[0], 0, i, pose).position;
      expectNear(position, glm::vec3(expected[i][0], -expected[i][2], expected[i][1]));
      EXPECT_LE(glm::distance(glm::dvec3(position), sphere.centre), sphere.radiusMetres + 1e-6);
    }
  }
}

TEST(Morph, IsRefusedWhereItIsNone) {
  const auto spoilt = [](const std::function<void(json&)>& spoil) {
    GltfBuilder builder = morphing();
    spoil(builder.root);
    const hal::Result<Model> model = parseGltf(builder.bytes(), "m.glb");
    return model ? "(was taken)" : model.error().message();
  };
  EXPECT_EQ(spoilt([](json&) {}), "(was taken)");
  EXPECT_EQ(spoilt([](json& r) { r["accessors"][1]["count"] = 2; }),
            "m.glb: meshes[0].primitives[0].targets[0].POSITION: has 2 elements, POSITION 3");
  EXPECT_EQ(spoilt([](json& r) { r["meshes"][0]["weights"] = {1}; }),
            "m.glb: meshes[0].weights: has 1, of 2 morph targets");
  EXPECT_EQ(spoilt([](json& r) {
              r["nodes"][0]["weights"] = {1, 2, 3};
            }),
            "m.glb: nodes[0].weights: has 3, of 2 morph targets");
  EXPECT_EQ(spoilt([](json& r) {
              r["nodes"][0]["weights"] = {1, 1e300};
            }),
            "m.glb: nodes[0].weights: found 1e+300; numbers of at most 1000000000");
  EXPECT_EQ(spoilt([](json& r) { r["meshes"][0]["primitives"][0]["targets"][1]["POSITION"] = 77; }),
            "m.glb: meshes[0].primitives[0].targets[1].POSITION: there is no accessors[77]");
  EXPECT_EQ(spoilt([](json& r) {
              r["meshes"][0]["primitives"].push_back(r["meshes"][0]["primitives"][0]);
              r["meshes"][0]["primitives"][1]["targets"].erase(0);
            }),
            "m.glb: meshes[0].primitives[1].targets: has 1, primitives[0] 2");
  EXPECT_EQ(spoilt([](json& r) {
              json& targets = r["meshes"][0]["primitives"][0]["targets"];
              while (targets.size() < 65) targets.push_back(json(targets[0]));
            }),
            "m.glb: meshes[0].primitives[0].targets: has 65 morph targets; at most 64");
}

TEST(Morph, IsNotReadWithoutBounds) {
  GltfBuilder builder;
  auto& primitive = builder.addMesh(kTriangle);
  // small in the file, but 64 times 150,000 offsets, twice
  builder.root["accessors"][0] = {{"componentType", 5126}, {"count", 150'000}, {"type", "VEC3"}};
  for (int i = 0; i < 64; ++i) primitive["targets"].push_back({{"POSITION", 0}});
  const hal::Result<Model> model = parseGltf(builder.bytes(), "m.glb");
  ASSERT_FALSE(model);
  EXPECT_EQ(
      model.error().message(),
      "m.glb: meshes[0].primitives[0].targets: exceed the total number of vertex offsets; at most "
      "16000000 in all");
}

TEST(Morph, IsNotShownWithoutBounds) {
  GltfBuilder builder = morphing();
  json& targets = builder.root["meshes"][0]["primitives"][0]["targets"];
  while (targets.size() < 64) targets.push_back(json(targets[0]));
  std::vector<std::uint8_t> indices;
  for (int i = 0; i < 100; ++i) indices.insert(indices.end(), {0, 1, 2});
  builder.root["meshes"][0]["primitives"][0]["indices"] =
      builder.addAccessor(indices, "SCALAR", 5121, 1);
  for (int i = 0; i < 2000; ++i) builder.root["nodes"].push_back({{"mesh", 0}});
  const hal::Result<Model> model = parseGltf(builder.bytes(), "m.glb");
  ASSERT_FALSE(model);  // 64 targets of 3 vertices and 100 triangles: 6592 each
  EXPECT_EQ(model.error().message(),
            "m.glb: nodes[1213]: exceeds the total number of morphed vertices; at most 8000000 "
            "in all, counted for each target");
}

}  // namespace
}  // namespace pleinair::scene
