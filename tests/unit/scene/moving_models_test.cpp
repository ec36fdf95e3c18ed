// The built-in models that deform: sound solids that move as they say.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "pipeline/scene/builtin/builtin_moving.h"
#include "pipeline/scene/description/scene_file.h"
#include "pipeline/scene/models/model_pose.h"
#include "tests/unit/scene/solid_checks.h"

namespace pleinair::scene {
namespace {

constexpr double kLength = 0.5;

/// The surface as posed at a moment of the only clip, in the model's frame.
Mesh posedAt(const Model& model, double seconds) {
  ModelPose pose;
  poseModel(model, ClipMoment{0, seconds}, {}, pose);
  Mesh mesh = model.surfaces.front().mesh;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    mesh.vertices[i] = posedVertex(model, model.parts.front(), 0, i, pose);
  }
  return mesh;
}

double apart(const Mesh& a, const Mesh& b, std::size_t vertex) {
  return glm::distance(a.vertices[vertex].position, b.vertices[vertex].position);
}

double lowest(const Mesh& mesh) {
  const auto low = std::ranges::min_element(mesh.vertices, {},
                                            [](const MeshVertex& each) { return each.position.z; });
  return low->position.z;
}

void expectSound(const Model& model) {
  const Mesh& mesh = model.surfaces.front().mesh;
  EXPECT_EQ(unmatchedEdges(mesh), 0);
  EXPECT_EQ(eulerCharacteristic(mesh), 2);
  EXPECT_NEAR(lowest(mesh), 0.0, 1e-6);
  ASSERT_EQ(model.rig.clips.size(), 1U);
  const double seconds = model.rig.clips.front().seconds;
  const Mesh first = posedAt(model, 0.0);
  const Mesh last = posedAt(model, seconds);
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 101) {
    EXPECT_LT(apart(first, last, i), 1e-6) << "it repeats without a jump";
  }
  for (const double part : {0.0, 0.2, 0.45, 0.7, 0.9}) {
    EXPECT_EQ(wrongNormals(posedAt(model, part * seconds), 0.6), 0) << part;
  }
}

TEST(MovingModels, TheTubeStandsAndSways) {
  const Model model = tubeModel({.lengthMetres = kLength});
  expectSound(model);
  const double radius = 0.15 * kLength;
  const double volume =
      std::numbers::pi * radius * radius * ((kLength - radius) + 2.0 / 3.0 * radius);
  EXPECT_NEAR(volumeOf(model.surfaces.front().mesh), volume, 0.02 * volume);
  for (const JointWeights& each : model.surfaces.front().mesh.joints) {
    EXPECT_NEAR(each.weights[0] + each.weights[1], 1.0F, 1e-6F);
  }
  const std::size_t top = model.surfaces.front().mesh.vertices.size() - 1;
  const Mesh left = posedAt(model, 0.3);
  const Mesh right = posedAt(model, 1.3);
  EXPECT_GT(apart(left, right, top), 0.3 * kLength);
  EXPECT_LT(apart(left, right, 0), 1e-6) << "its foot stands";
}

TEST(MovingModels, TheBallChangesItsShapeOnTheGround) {
  const Model model = ballModel({.diameterMetres = kLength});
  expectSound(model);
  const double volume = std::numbers::pi / 6.0 * std::pow(kLength, 3.0);
  EXPECT_NEAR(volumeOf(model.surfaces.front().mesh), volume, 0.01 * volume);
  double widest = 0.0;
  double highest = 0.0;
  double flattest = 1.0;
  for (int i = 0; i < 24; ++i) {
    const Mesh mesh = posedAt(model, 0.1 * i);
    EXPECT_GT(lowest(mesh), -1e-6);
    double high = 0.0;
    for (const MeshVertex& each : mesh.vertices) {
      high = std::max<double>(high, each.position.z);
      widest = std::max<double>(widest, std::hypot(each.position.x, each.position.y));
    }
    highest = std::max(highest, high);
    flattest = std::min(flattest, high);
  }
  EXPECT_GT(widest, 0.6 * kLength);
  EXPECT_GT(highest - flattest, 0.25 * kLength);
}

TEST(MovingModels, AreNamedInScenes) {
  const Scene scene = parseScene(R"(
[[tag]]
id = 0
edge_m = 0.1
[[model]]
source = "builtin:tube"
attach = "tag:0"
length_m = 0.3
[[model]]
source = "builtin:ball"
attach = "tag:0"
speed = 0.5
)",
                                 "scene.toml", ".");
  EXPECT_EQ(std::get<TubeSource>(scene.models[0].source), (TubeSource{.lengthMetres = 0.3}));
  EXPECT_EQ(std::get<BallSource>(scene.models[1].source), BallSource{});
  EXPECT_EQ(scene.models[0].srgb, glm::vec3(1.0F)) << "it has colours of its own";
  EXPECT_TRUE(scene.models[0].playback.clip) << "its only clip plays";
  EXPECT_EQ(scene.models[1].playback.speed, 0.5);
}

}  // namespace
}  // namespace pleinair::scene
