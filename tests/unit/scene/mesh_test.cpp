#include "pipeline/scene/mesh.h"

#include <cmath>

#include <gtest/gtest.h>

#include "pipeline/scene/builtin_box.h"
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

}  // namespace
}  // namespace pleinair::scene
