#include "pipeline/scene/models/mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "pipeline/scene/builtin/builtin_box.h"
#include "tests/unit/scene/solid_checks.h"

namespace pleinair::scene {
namespace {

TEST(BoxMesh, IsTheBoxItself) {
  const Mesh box = boxMesh({2.0, 4.0, 0.5});
  EXPECT_EQ(box.triangles.size(), 12u);
  EXPECT_EQ(box.vertices.size(), 24u);
  EXPECT_EQ(unmatchedEdges(box), 0);
  EXPECT_EQ(eulerCharacteristic(box), 2);
  EXPECT_EQ(wrongNormals(box, 0.99999), 0);
  EXPECT_DOUBLE_EQ(volumeOf(box), 4.0);
  for (const MeshVertex& vertex : box.vertices) {
    EXPECT_EQ(std::abs(vertex.position.x), 1.0F);
    EXPECT_EQ(std::abs(vertex.position.y), 2.0F);
    EXPECT_TRUE(vertex.position.z == 0.0F || vertex.position.z == 0.5F);
  }
}

TEST(BoundingSphere, HoldsTheMesh) {
  const BoundingSphere sphere = boundingSphere(boxMesh({2.0, 4.0, 4.0}));
  EXPECT_EQ(sphere.centre, glm::dvec3(0.0, 0.0, 2.0));
  EXPECT_DOUBLE_EQ(sphere.radiusMetres, 3.0);
  EXPECT_EQ(boundingSphere({}).radiusMetres, 0.0);
}

TEST(ShortEdges, KeepTheSurfaceClosedAndAsItWas) {
  const Mesh box = boxMesh({2.0, 4.0, 0.5});
  const Mesh fine = withShortEdges(box, 0.3F);
  EXPECT_GT(fine.triangles.size(), 500u);
  EXPECT_EQ(unmatchedEdges(fine), 0);
  EXPECT_EQ(wrongNormals(fine, 0.99999), 0);
  EXPECT_NEAR(volumeOf(fine), 4.0, 1e-9);
  for (std::size_t t = 0; t < fine.triangles.size(); ++t) {
    const auto corners = cornersOf(fine, t);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LE(glm::distance(corners[i], corners[(i + 1) % 3]), 0.3001);
    }
  }
}

TEST(ShortEdges, LeaveAFineMeshAlone) {
  const Mesh box = boxMesh({2.0, 4.0, 0.5});
  EXPECT_EQ(withShortEdges(box, 10.0F).triangles.size(), box.triangles.size());
}

/// A square of two triangles, folded along the edge that they share.
Mesh heldSquare() {
  Mesh square;
  for (const glm::vec3 corner :
       {glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(1, 1, 0.5F), glm::vec3(0, 1, 0)}) {
    square.vertices.push_back({.position = corner, .normal = {0, 0, 1}});
  }
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  square.joints = {{.joints = {0, 1, 2, 3}, .weights = {0.4F, 0.3F, 0.2F, 0.1F}},
                   {.joints = {1, 0, 0, 0}, .weights = {1, 0, 0, 0}},
                   {.joints = {4, 5, 6, 0}, .weights = {0.5F, 0.3F, 0.2F, 0}},
                   {.joints = {1, 0, 0, 0}, .weights = {1, 0, 0, 0}}};
  square.morphTargets = {{.positions = {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}}}};
  return square;
}

TEST(ShortEdges, ShareTheirVertices) {
  const Mesh fine = withShortEdges(heldSquare(), 0.1F);
  EXPECT_GT(fine.triangles.size(), 200u);
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& triangle : fine.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      edges.insert(std::minmax(triangle[i], triangle[(i + 1) % 3]));
    }
  }
  // by indices; the Euler characteristic of a disc is 1
  EXPECT_EQ(fine.vertices.size() + fine.triangles.size(), edges.size() + 1);
  std::set<std::array<float, 3>> places;
  for (const MeshVertex& vertex : fine.vertices) {
    places.insert({vertex.position.x, vertex.position.y, vertex.position.z});
  }
  EXPECT_EQ(places.size(), fine.vertices.size());
}

TEST(ShortEdges, KeepWhatHoldsAndMorphsVertices) {
  const Mesh fine = withShortEdges(heldSquare(), 0.9F);
  ASSERT_EQ(fine.joints.size(), fine.vertices.size());
  ASSERT_EQ(fine.morphTargets[0].positions.size(), fine.vertices.size());
  EXPECT_TRUE(fine.morphTargets[0].normals.empty());
  const auto half = [&](const glm::vec3& at) {
    for (std::size_t i = 0; i < fine.vertices.size(); ++i) {
      if (glm::distance(fine.vertices[i].position, at) < 1e-6F) return i;
    }
    ADD_FAILURE() << "no vertex there";
    return std::size_t{0};
  };
  // between joints 0 to 3 and 4 to 6: the strongest four, which are 0.25, 0.2, 0.15 and 0.15
  const std::size_t middle = half({0.5F, 0.5F, 0.25F});
  EXPECT_EQ(fine.joints[middle].joints, (std::array<std::uint16_t, 4>{4, 0, 1, 5}));
  const std::array<float, 4> weights{0.25F / 0.75F, 0.2F / 0.75F, 0.2F, 0.2F};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(fine.joints[middle].weights[i], weights[i], 1e-6);
  EXPECT_FLOAT_EQ(fine.morphTargets[0].positions[middle].z, 1.0F);
  // between joint 1 and joints 0 to 3: 0.65 of joint 1
  const std::size_t edge = half({0.5F, 0, 0});
  EXPECT_EQ(fine.joints[edge].joints, (std::array<std::uint16_t, 4>{1, 0, 2, 3}));
  EXPECT_NEAR(fine.joints[edge].weights[0], 0.65F, 1e-6);
  EXPECT_FLOAT_EQ(fine.morphTargets[0].positions[edge].z, 0.5F);
  // all original vertices keep their positions
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(fine.vertices[i].position, heldSquare().vertices[i].position);
    EXPECT_EQ(fine.joints[i].weights, heldSquare().joints[i].weights);
  }
}

TEST(ShortEdges, LeaveNoCracksAlongHardEdges) {
  Mesh box = boxMesh({2.0, 4.0, 0.5});  // each side has its own vertices
  for (const MeshVertex& vertex : box.vertices) {
    const auto at = [&](int axis, float most) { return 0.5F + vertex.position[axis] / most; };
    const float left = 0.3F * at(0, 2.0F);
    const float front = 0.4F * at(1, 4.0F);
    box.joints.push_back(
        {.joints = {static_cast<std::uint16_t>(vertex.position.x > 0.0F ? 1 : 2), 3,
                    static_cast<std::uint16_t>(vertex.position.y > 0.0F ? 4 : 5), 6},
         .weights = {left, front, 0.2F, 0.8F - left - front}});
  }
  const Mesh fine = withShortEdges(box, 0.3F);
  std::map<std::array<float, 3>, JointWeights> heldAt;
  for (std::size_t i = 0; i < fine.vertices.size(); ++i) {
    const glm::vec3& p = fine.vertices[i].position;
    const JointWeights& held = heldAt.try_emplace({p.x, p.y, p.z}, fine.joints[i]).first->second;
    EXPECT_EQ(held.joints, fine.joints[i].joints);  // exactly the same from both sides
    EXPECT_EQ(held.weights, fine.joints[i].weights);
  }
  EXPECT_LT(heldAt.size(), fine.vertices.size());
  EXPECT_EQ(unmatchedEdges(fine), 0);
}

}  // namespace
}  // namespace pleinair::scene
