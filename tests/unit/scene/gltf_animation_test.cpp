// Animations as files have them: what becomes clips, what is left out, what is refused.
#include <cmath>
#include <functional>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "pipeline/scene/gltf/gltf_accessors.h"
#include "pipeline/scene/gltf/gltf_file.h"
#include "pipeline/scene/models/model_pose.h"
#include "tests/oracles/gltf_oracle.h"
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

json channelOf(int sampler, int node, const std::string& path) {
  return {{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}};
}

/// Node 0 shows a triangle below node 1; "slide" moves node 0, with keys at 0.5 and 2.5 s.
GltfBuilder sliding() {
  GltfBuilder builder;
  builder.addMesh(kTriangle, "slide");
  builder.root["nodes"].push_back({{"translation", {0, 0, 5}}, {"children", {0}}});
  const int times = builder.addFloats({0.5, 2.5}, "SCALAR", 1);        // accessor 1
  const int moves = builder.addFloats({0, 0, 0, 4, 8, 0}, "VEC3", 3);  // accessor 2
  builder.root["animations"] = {{{"name", "slide"},
                                 {"channels", {channelOf(0, 0, "translation")}},
                                 {"samplers", {{{"input", times}, {"output", moves}}}}}};
  return builder;
}

glm::dvec3 cornerOf(const Model& model, const std::optional<ClipMoment>& moment,
                    std::size_t vertex = 0, std::size_t part = 0) {
  ModelPose pose;
  poseModel(model, moment, hal::Duration::zero(), pose);
  return glm::dvec3(posedVertex(model, model.parts[part], 0, vertex, pose).position);
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_LT(glm::distance(a, b), 1e-6) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(GltfAnimation, MovesWhatANodeShows) {
  const Model model = parsed(sliding());
  ASSERT_EQ(model.rig.clips.size(), 1u);
  EXPECT_EQ(model.rig.clips[0].name, "slide");
  EXPECT_EQ(model.rig.clips[0].seconds, 2.5);
  expectNear(cornerOf(model, std::nullopt), {0, -5, 0});
  expectNear(cornerOf(model, ClipMoment{0, 0.0}), {0, -5, 0});
  expectNear(cornerOf(model, ClipMoment{0, 1.0}), {1, -5, 2});
  expectNear(cornerOf(model, ClipMoment{0, 2.5}), {4, -5, 8});
  EXPECT_THAT(model.notices, testing::IsEmpty());
}

TEST(GltfAnimation, TakesParentsAlong) {
  GltfBuilder builder = sliding();
  builder.root["animations"][0]["channels"][0]["target"]["node"] = 1;
  const Model model = parsed(builder);
  expectNear(cornerOf(model, ClipMoment{0, 2.5}), {4, 0, 8});
}

TEST(GltfAnimation, SharesSamplers) {
  GltfBuilder builder = sliding();
  builder.root["animations"][0]["channels"].push_back(channelOf(0, 1, "translation"));
  builder.root["animations"][0]["channels"].push_back(channelOf(0, 1, "scale"));
  builder.root["animations"][0]["samplers"][0]["interpolation"] = "STEP";
  const Model model = parsed(builder);
  ASSERT_EQ(model.rig.clips[0].channels.size(), 3u);
  // its own (4, 8, 0) scaled by (4, 8, 0), and moved by (4, 8, 0)
  expectNear(cornerOf(model, ClipMoment{0, 2.5}), {20, 0, 72});
}

TEST(GltfAnimation, ReadsTurnsOfNormalisedIntegers) {
  GltfBuilder builder = sliding();
  const int bytes =
      builder.addAccessor<std::int8_t>({0, 0, 0, 127, 0, 0, 90, 90}, "VEC4", 5120, 4, true);
  const int words = builder.addAccessor<std::int16_t>({0, 0, 0, 32767, 0, 0, 23170, 23170}, "VEC4",
                                                      5122, 4, true);
  for (const int turns : {bytes, words}) {
    builder.root["animations"][0]["channels"] = {channelOf(0, 0, "rotation")};
    builder.root["animations"][0]["samplers"][0]["output"] = turns;
    const Model model = parsed(builder);
    expectNear(cornerOf(model, ClipMoment{0, 2.5}, 1), {0, -5, 1});
    const double eighth = std::sqrt(0.5);
    expectNear(cornerOf(model, ClipMoment{0, 1.5}, 1), {eighth, -5, eighth});
  }
}

TEST(GltfAnimation, OfEveryKindIsWhereTheSpecificationSays) {
  for (const std::string kind : {"STEP", "LINEAR", "CUBICSPLINE"}) {
    GltfBuilder builder = sliding();
    const std::size_t parts = kind == "CUBICSPLINE" ? 3 : 1;
    const int times = builder.addFloats({0.25, 1, 1.5, 3}, "SCALAR", 1);
    json channels;
    json samplers;
    for (const std::string path : {"translation", "rotation", "scale"}) {
      const std::size_t width = path == "rotation" ? 4 : 3;
      std::vector<float> values;
      for (std::size_t i = 0; i < 4 * parts * width; ++i) {
        values.push_back(static_cast<float>(std::sin(0.7 * static_cast<double>(i * i))));
      }
      channels.push_back(channelOf(static_cast<int>(samplers.size()), 0, path));
      samplers.push_back(
          {{"input", times},
           {"output", builder.addFloats(values, "VEC" + std::to_string(width), width)},
           {"interpolation", kind}});
    }
    builder.root["animations"] = {{{"channels", channels}, {"samplers", samplers}}};
    const Model model = parsed(builder);
    const oracles::GltfOracle oracle(builder.bytes());
    for (double seconds = 0.0; seconds < 3.5; seconds += 0.07) {
      const auto expected = oracle.corners(0, 0, 0, seconds);
      for (std::size_t i = 0; i < 3; ++i) {
        expectNear(cornerOf(model, ClipMoment{0, seconds}, i),
                   {expected[i][0], -expected[i][2], expected[i][1]});
      }
    }
  }
}

TEST(GltfAnimation, HasANameOfItsOwn) {
  GltfBuilder builder = sliding();
  json& animations = builder.root["animations"];
  for (const char* name : {"slide", "", "slide 2", "slide"}) {
    animations.push_back(animations[0]);
    animations.back()["name"] = name;
  }
  animations.back().erase("name");
  animations.push_back(animations[0]);
  const Model model = parsed(builder);
  std::vector<std::string> names;
  for (const Clip& clip : model.rig.clips) names.push_back(clip.name);
  EXPECT_THAT(names, testing::ElementsAre("slide", "slide 2", "animation 3", "slide 2 2",
                                          "animation 5", "slide 3"));
}

TEST(GltfAnimation, LeavesOutWhatTheSpecificationSaysToIgnore) {
  GltfBuilder builder = sliding();
  json& channels = builder.root["animations"][0]["channels"];
  channels.push_back({{"sampler", 0}, {"target", {{"path", "translation"}}}});
  channels.push_back(
      {{"sampler", 0},
       {"target",
        {{"path", "pointer"},
         {"extensions", {{"KHR_animation_pointer", {{"pointer", "/materials/0/alphaCutoff"}}}}}}}});
  const Model model = parsed(builder);
  EXPECT_EQ(model.rig.clips[0].channels.size(), 1u);
  EXPECT_THAT(model.notices, testing::ElementsAre(
                                 "its animations have unsupported targets: \"pointer\"",
                                 "1 of its animations' channels name no node and are not played"));
}

TEST(GltfAnimation, MayMoveWhatAMatrixPlaces) {
  GltfBuilder builder = sliding();
  builder.root["nodes"][1] = {
      {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 9, 1}},  // a quarter turn about z
      {"children", {0}}};
  expectNear(cornerOf(parsed(builder), ClipMoment{0, 2.5}), {-8, -9, 4});
}

TEST(GltfAnimation, KeepsPosesFinite) {
  GltfBuilder builder = sliding();
  json& nodes = builder.root["nodes"];
  json channels = json::array();
  const int sizes = builder.addFloats({1, 1, 1, 1e9F, 1e9F, 1e9F}, "VEC3", 3);
  for (int i = 2; i < 60; ++i) {  // a tower of scales of 1e9
    nodes.push_back({{"children", {i - 1}}});
    channels.push_back(channelOf(0, i, "scale"));
  }
  builder.root["animations"][0]["channels"] = channels;
  builder.root["animations"][0]["samplers"][0]["output"] = sizes;
  const Model model = parsed(builder);
  for (const double seconds : {0.0, 0.6, 1.0, 2.5}) {
    const glm::dvec3 corner = cornerOf(model, ClipMoment{0, seconds}, 1);
    EXPECT_TRUE(std::isfinite(corner.x) && std::isfinite(corner.y) && std::isfinite(corner.z));
    ModelPose pose;
    poseModel(model, ClipMoment{0, seconds}, hal::Duration::zero(), pose);
    EXPECT_TRUE(std::isfinite(boundingSphere(model, pose).radiusMetres));
  }
}

struct Spoiling {
  std::string name;
  std::function<void(GltfBuilder&)> spoil;
  std::string message;
};

class AnimationRefusal : public testing::TestWithParam<Spoiling> {};

TEST_P(AnimationRefusal, SaysWhereAndWhat) {
  GltfBuilder builder = sliding();
  GetParam().spoil(builder);
  const hal::Result<Model> model = parseGltf(builder.bytes(), "m.glb");
  EXPECT_EQ(model ? "(was taken)" : model.error().message(), "m.glb: " + GetParam().message);
}

json& samplerOf(GltfBuilder& builder) {
  return builder.root["animations"][0]["samplers"][0];
}
json& channelOf(GltfBuilder& builder) {
  return builder.root["animations"][0]["channels"][0];
}

INSTANTIATE_TEST_SUITE_P(
    All, AnimationRefusal,
    testing::Values(
        Spoiling{"List", [](GltfBuilder& b) { b.root["animations"] = 7; },
                 "animations: is not an array"},
        Spoiling{"Channels", [](GltfBuilder& b) { b.root["animations"][0]["channels"] = {1}; },
                 "animations[0].channels[0]: is not an object"},
        Spoiling{"Target", [](GltfBuilder& b) { channelOf(b)["target"] = "x"; },
                 "animations[0].channels[0].target: is not an object"},
        Spoiling{"Node", [](GltfBuilder& b) { channelOf(b)["target"]["node"] = 9; },
                 "animations[0].channels[0].target.node: there is no nodes[9]"},
        Spoiling{"NegativeNode", [](GltfBuilder& b) { channelOf(b)["target"]["node"] = -1; },
                 "animations[0].channels[0].target.node: is not a whole number from 0 up"},
        Spoiling{"Path", [](GltfBuilder& b) { channelOf(b)["target"].erase("path"); },
                 "animations[0].channels[0].target.path: missing"},
        Spoiling{"Sampler", [](GltfBuilder& b) { channelOf(b)["sampler"] = 1; },
                 "animations[0].channels[0].sampler: there is no animations[0].samplers[1]"},
        Spoiling{"NoSampler", [](GltfBuilder& b) { channelOf(b).erase("sampler"); },
                 "animations[0].channels[0].sampler: missing"},
        Spoiling{"Twice",
                 [](GltfBuilder& b) {
                   b.root["animations"][0]["channels"].push_back(channelOf(0, 0, "translation"));
                 },
                 "animations[0].channels[1].target: is moved by a channel above already"},
        Spoiling{"Matrix",
                 [](GltfBuilder& b) {
                   b.root["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
                 },
                 "animations[0].channels[0].target: nodes[0] has a matrix, so that its parts "
                 "cannot be moved; translation, rotation and scale in its place"},
        Spoiling{"Weights", [](GltfBuilder& b) { channelOf(b)["target"]["path"] = "weights"; },
                 "animations[0].channels[0].target: nodes[0] shows nothing that has morph targets"},
        Spoiling{"Interpolation", [](GltfBuilder& b) { samplerOf(b)["interpolation"] = "BEZIER"; },
                 "animations[0].samplers[0].interpolation: found \"BEZIER\"; LINEAR, STEP, "
                 "CUBICSPLINE"},
        Spoiling{"Input", [](GltfBuilder& b) { samplerOf(b)["input"] = 9; },
                 "animations[0].samplers[0].input: there is no accessors[9]"},
        Spoiling{"HugeInput", [](GltfBuilder& b) { samplerOf(b)["input"] = 1ULL << 63U; },
                 "animations[0].samplers[0].input: there is no accessors[9223372036854775808]"},
        Spoiling{"NoOutput", [](GltfBuilder& b) { samplerOf(b).erase("output"); },
                 "animations[0].samplers[0].output: missing"},
        Spoiling{"TimesOfVectors", [](GltfBuilder& b) { samplerOf(b)["input"] = 2; },
                 "animations[0].samplers[0].input: accessors[2] has elements of 3 numbers, not 1"},
        Spoiling{"OutputOfFour",
                 [](GltfBuilder& b) { channelOf(b)["target"]["path"] = "rotation"; },
                 "animations[0].samplers[0].output: accessors[2] has elements of 3 numbers, not 4"},
        Spoiling{"TooFewValues", [](GltfBuilder& b) { b.root["accessors"][2]["count"] = 1; },
                 "animations[0].samplers[0].output: has 3 numbers, for 2 keys of 3"},
        Spoiling{"NoTangents",
                 [](GltfBuilder& b) { samplerOf(b)["interpolation"] = "CUBICSPLINE"; },
                 "animations[0].samplers[0].output: has 6 numbers, for 2 keys of 9"},
        Spoiling{"Falling",
                 [](GltfBuilder& b) {
                   samplerOf(b)["input"] = b.addFloats({2, 1}, "SCALAR", 1);
                 },
                 "animations[0].samplers[0].input: has a key at 1 s after one at 2 s; times that "
                 "rise from key to key"},
        Spoiling{"Standing",
                 [](GltfBuilder& b) {
                   samplerOf(b)["input"] = b.addFloats({1, 1}, "SCALAR", 1);
                 },
                 "animations[0].samplers[0].input: has a key at 1 s after one at 1 s; times that "
                 "rise from key to key"},
        Spoiling{"Negative",
                 [](GltfBuilder& b) {
                   samplerOf(b)["input"] = b.addFloats({-1, 1}, "SCALAR", 1);
                 },
                 "animations[0].samplers[0].input: starts at -1 s"},
        Spoiling{"NoTime",
                 [](GltfBuilder& b) {
                   samplerOf(b)["input"] = b.addFloats({0, std::nanf("")}, "SCALAR", 1);
                 },
                 "animations[0].samplers[0].input: accessors[3], element 1: found nan; a number of "
                 "at most 1000000000"},
        Spoiling{"WholeTimes",
                 [](GltfBuilder& b) {
                   samplerOf(b)["input"] = b.addAccessor<std::uint8_t>({0, 1}, "SCALAR", 5121, 1);
                 },
                 "animations[0].samplers[0].input: accessors[3] is not of floats"},
        Spoiling{"NoRotation",
                 [](GltfBuilder& b) {
                   channelOf(b)["target"]["path"] = "rotation";
                   samplerOf(b)["output"] = b.addFloats({0, 0, 0, 1, 0, 0, 0, 0}, "VEC4", 4);
                 },
                 "animations[0].samplers[0].output: key 1: is no rotation"},
        Spoiling{"WholeTurns",
                 [](GltfBuilder& b) {
                   channelOf(b)["target"]["path"] = "rotation";
                   samplerOf(b)["output"] =
                       b.addAccessor<std::int8_t>({0, 0, 0, 1, 0, 0, 0, 1}, "VEC4", 5120, 4);
                 },
                 "animations[0].samplers[0].output: accessors[3] is not of floats nor normalised "
                 "integers"},
        Spoiling{"HugeCount",
                 [](GltfBuilder& b) {
                   b.root["accessors"][1]["count"] = 4'000'000'000U;
                   b.root["accessors"][1].erase("bufferView");
                 },
                 "accessors[1].count: found 4000000000; from 1 to 3000000"}),
    [](const auto& instance) { return instance.param.name; });

TEST(AnimationRefusals, BoundTheKeysOfAllAnimations) {
  GltfBuilder builder = sliding();
  std::vector<float> times(1000);
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = static_cast<float>(i);
  samplerOf(builder) = {{"input", builder.addFloats(times, "SCALAR", 1)},
                        {"output", builder.addFloats(std::vector<float>(3000), "VEC3", 3)}};
  json& channels = builder.root["animations"][0]["channels"];
  for (int node = 1; node < 4001; ++node) {
    builder.root["nodes"].push_back(json::object());
    channels.push_back(channelOf(0, node, "translation"));
  }
  const hal::Result<Model> model = parseGltf(builder.bytes(), "m.glb");
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().message(),
            "m.glb: animations[0].samplers[0].input: exceeds the total number of values; at most "
            "16000000 in all");
}

}  // namespace
}  // namespace pleinair::scene
