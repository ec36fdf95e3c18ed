// Poses of hand-made models.
#include "pipeline/scene/models/model_pose.h"

#include <cmath>
#include <numbers>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "pipeline/scene/builtin/builtin_box.h"
#include "pipeline/scene/builtin/builtin_gearbox.h"
#include "pipeline/scene/models/mesh.h"
#include "tests/support/allocation_count.h"

namespace pleinair::scene {
namespace {

using std::chrono::milliseconds;

/// Two bones, the second one metre above the first, and a box of 1 × 1 × 2 m. The lower half
/// follows the first bone and the upper half the second. A morph target widens the box. "bend"
/// turns the second bone by 90° in one second and widens the box.
Model bentBox() {
  Model model = singlePartModel("box", boxMesh({1.0, 1.0, 2.0}));
  Mesh& mesh = model.surfaces[0].mesh;
  MorphTarget wide;
  for (const MeshVertex& vertex : mesh.vertices) {
    const std::uint16_t joint = vertex.position.z > 1.0F ? 1 : 0;
    mesh.joints.push_back({.joints = {joint, 0, 0, 0}});
    wide.positions.emplace_back(vertex.position.x, 0.0F, 0.0F);
  }
  mesh.morphTargets = {wide};
  Rig& rig = model.rig;
  rig.nodes = {{}, {.parent = 0, .rest = {.translation = {0, 0, 1}}}, {.weights = {0.0F}}};
  rig.skins = {
      {.joints = {0, 1},
       .jointFromMesh = {glm::dmat4(1.0), glm::translate(glm::dmat4(1.0), {0.0, 0.0, -1.0})}}};
  const auto half = static_cast<float>(std::sqrt(0.5));
  rig.clips = {{.name = "bend",
                .seconds = 1.0,
                .channels = {{.node = 1,
                              .property = AnimatedProperty::kRotation,
                              .seconds = {0, 1},
                              .values = {0, 0, 0, 1, 0, half, 0, half},
                              .width = 4},
                             {.node = 2,
                              .property = AnimatedProperty::kWeights,
                              .seconds = {0, 1},
                              .values = {0, 1},
                              .width = 1}}}};
  rig.modelFromRoot = glm::translate(glm::dmat4(1.0), {0.0, 0.0, 5.0});
  model.parts[0].skin = 0;
  model.parts[0].node = 2;
  numberParts(model);
  return model;
}

TEST(ModelPose, BendsWithJointsAndMorphs) {
  const Model model = bentBox();
  ModelPose pose;
  poseModel(model, ClipMoment{0, 1.0}, hal::Duration::zero(), pose);
  ASSERT_EQ(pose.matrices.size(), 2u);
  ASSERT_EQ(pose.weights.size(), 1u);
  EXPECT_EQ(pose.weights[0], 1.0F);
  const Mesh& mesh = model.surfaces[0].mesh;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const MeshVertex& bound = mesh.vertices[i];
    const glm::vec3 wide(2.0F * bound.position.x, bound.position.y, bound.position.z);
    // upper half: about the joint at z = 1, z becomes x and x becomes −z
    const bool isUpper = bound.position.z > 1.0F;
    const glm::vec3 position = isUpper ? glm::vec3(wide.z - 1.0F, wide.y, 1.0F - wide.x) : wide;
    const glm::vec3 normal =
        isUpper ? glm::vec3(bound.normal.z, bound.normal.y, -bound.normal.x) : bound.normal;
    const MeshVertex posed = posedVertex(model, model.parts[0], 0, i, pose);
    EXPECT_LT(glm::distance(posed.position, position + glm::vec3(0, 0, 5)), 1e-6F);
    EXPECT_LT(glm::distance(posed.normal, normal), 1e-6F);
  }
}

TEST(ModelPose, IsHeldByItsSphereTightly) {
  const Model model = bentBox();
  ModelPose pose;
  for (int i = 0; i <= 20; ++i) {
    poseModel(model, ClipMoment{0, 0.05 * i}, hal::Duration::zero(), pose);
    const BoundingSphere sphere = boundingSphere(model, pose);
    double farthest = 0.0;
    for (std::size_t v = 0; v < model.surfaces[0].mesh.vertices.size(); ++v) {
      const glm::dvec3 p(posedVertex(model, model.parts[0], 0, v, pose).position);
      farthest = std::max(farthest, glm::distance(p, sphere.centre));
    }
    EXPECT_LE(farthest, sphere.radiusMetres + 1e-6);
    EXPECT_LT(sphere.radiusMetres, 2.0 * farthest);
  }
}

TEST(ModelPose, APartThatIsHiddenIsNotInItsSphere) {
  Model model = bentBox();
  model.parts.push_back(model.parts[0]);
  numberParts(model);
  ModelPose pose;
  poseModel(model, std::nullopt, hal::Duration::zero(), pose);
  for (glm::dmat4& matrix : pose.matrices) matrix[3] += glm::dvec4(100.0, 0.0, 0.0, 0.0);
  const BoundingSphere both = boundingSphere(model, pose);
  const ModelPart& second = model.parts[1];
  for (std::uint32_t i = 0; i < second.matrixCount; ++i) {
    pose.matrices[second.firstMatrix + i] = glm::dmat4(0.0);
  }
  const BoundingSphere one = boundingSphere(model, pose);
  EXPECT_LT(glm::distance(one.centre, both.centre), 1e-6) << "not half-way to the origin";
  EXPECT_LE(one.radiusMetres, both.radiusMetres + 1e-6);
}

TEST(ModelPose, AllocatesOnlyOnce) {
  const Model model = bentBox();
  ModelPose pose;
  poseModel(model, std::nullopt, hal::Duration::zero(), pose);
  double radii = 0.0;
  const int allocations = support::allocationsIn([&] {
    for (int i = 0; i < 100; ++i) {
      poseModel(model, ClipMoment{0, 0.01 * i}, milliseconds(i), pose);
      radii += boundingSphere(model, pose).radiusMetres;
    }
  });
  EXPECT_EQ(allocations, 0) << support::allocationSites();
  EXPECT_GT(radii, 0.0);
}

TEST(ModelPose, TurnsBuiltinParts) {
  const Model gearbox = gearboxModel({});
  ModelPose pose;
  for (const milliseconds time : {milliseconds(0), milliseconds(321), milliseconds(60'000)}) {
    poseModel(gearbox, std::nullopt, time, pose);
    ASSERT_EQ(pose.matrices.size(), gearbox.parts.size());
    for (const ModelPart& part : gearbox.parts) {
      EXPECT_EQ(pose.matrices[part.firstMatrix], modelFromPart(part, time)) << part.name;
    }
    // at every moment the bounds hold all vertices
    const BoundingSphere now = boundingSphere(gearbox, pose);
    const BoundingSphere ever = boundingSphere(gearbox);
    EXPECT_LE(glm::distance(now.centre, ever.centre) + now.radiusMetres, ever.radiusMetres * 1.5);
  }
}

TEST(ModelPose, LetsAPartTurnThatANodeCarries) {
  Model model = singlePartModel("box", boxMesh({1.0, 1.0, 1.0}));
  model.rig.nodes = {{.rest = {.translation = {3, 0, 0}}}};
  model.parts[0].node = 0;
  model.parts[0].radiansPerSecond = std::numbers::pi;
  ModelPose pose;
  poseModel(model, std::nullopt, milliseconds(500), pose);
  const glm::dvec3 x(pose.matrices[0] * glm::dvec4(1.0, 0.0, 0.0, 1.0));
  EXPECT_LT(glm::distance(x, glm::dvec3(3.0, 1.0, 0.0)), 1e-12);
}

TEST(ModelPose, KeepsSquashedNormalsOfUnitLength) {
  Model model = bentBox();
  for (const glm::dvec3 size : {glm::dvec3(1, 1, 0), glm::dvec3(0, 1, 0), glm::dvec3(0)}) {
    model.rig.nodes[0].rest.scale = size;
    ModelPose pose;
    poseModel(model, std::nullopt, hal::Duration::zero(), pose);
    for (std::size_t v = 0; v < model.surfaces[0].mesh.vertices.size(); ++v) {
      const glm::vec3 normal = posedVertex(model, model.parts[0], 0, v, pose).normal;
      EXPECT_NEAR(glm::length(normal), 1.0F, 1e-6F);
    }
  }
}

TEST(ModelPose, StandsAtRestAfterAClip) {
  const Model model = bentBox();
  ModelPose pose;
  poseModel(model, std::nullopt, hal::Duration::zero(), pose);
  const ModelPose rest = pose;
  poseModel(model, ClipMoment{0, 0.7}, hal::Duration::zero(), pose);
  EXPECT_NE(pose.matrices, rest.matrices);
  poseModel(model, std::nullopt, hal::Duration::zero(), pose);
  EXPECT_EQ(pose.matrices, rest.matrices);
  EXPECT_EQ(pose.weights, rest.weights);
}

TEST(ModelShortEdges, AreMeasuredWhereJointsTakeThem) {
  Model model = bentBox();
  model.rig.nodes[0].rest.scale = glm::dvec3(4.0);
  const Model fine = withShortEdges(model, 1.0, 1'000'000);
  EXPECT_GT(fine.triangleCount(), 200u);
  ModelPose pose;
  poseModel(fine, std::nullopt, hal::Duration::zero(), pose);
  for (const auto& triangle : fine.surfaces[0].mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = [&](std::size_t corner) {
        return posedVertex(fine, fine.parts[0], 0, triangle[corner % 3], pose).position;
      };
      EXPECT_LE(glm::distance(at(i), at(i + 1)), 1.0001F);
    }
  }
}

TEST(LargestScale, IsNeverTooSmallAndExactForAxes) {
  EXPECT_DOUBLE_EQ(largestScale(glm::dmat4(1.0)), 1.0);
  const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), 0.7, {1.0, 2.0, 3.0});
  EXPECT_NEAR(largestScale(glm::scale(turned, {1.0, 5.0, -2.0})), 5.0, 1e-12);
  glm::dmat4 shear(1.0);
  shear[1][0] = 2.0;  // its largest singular value is 1 + √2
  EXPECT_GE(largestScale(shear), 1.0 + std::numbers::sqrt2);
  EXPECT_LE(largestScale(shear), 1.1 * (1.0 + std::numbers::sqrt2));
}

}  // namespace
}  // namespace pleinair::scene
