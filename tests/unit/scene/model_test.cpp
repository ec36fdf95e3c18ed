#include "pipeline/scene/models/model.h"

#include <numbers>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "pipeline/scene/builtin/builtin_box.h"

namespace pleinair::scene {
namespace {

using std::chrono::milliseconds;

/// A box of 1 × 2 × 3 m whose part is translated and turns four times per second.
Model spinningBox() {
  Model model = singlePartModel("box", boxMesh({1.0, 2.0, 3.0}));
  model.parts[0].modelFromPart =
      glm::scale(glm::translate(glm::dmat4(1.0), {10.0, 0.0, 0.0}), glm::dvec3(2.0));
  model.parts[0].radiansPerSecond = 8.0 * std::numbers::pi;
  return model;
}

TEST(ModelPart, TurnsAboutItsOwnAxisWithTime) {
  const Model model = spinningBox();
  const auto corner = [&](hal::Duration time) {
    return glm::dvec3(modelFromPart(model.parts[0], time) * glm::dvec4(1.0, 0.0, 0.5, 1.0));
  };
  const auto expectNear = [](const glm::dvec3& a, const glm::dvec3& b) {
    EXPECT_LT(glm::distance(a, b), 1e-8) << a.x << ' ' << a.y << ' ' << a.z;
  };
  expectNear(corner(milliseconds(0)), {12.0, 0.0, 1.0});
  expectNear(corner(std::chrono::microseconds(62'500)), {10.0, 2.0, 1.0});
  expectNear(corner(milliseconds(125)), {8.0, 0.0, 1.0});
  expectNear(corner(std::chrono::hours(24)), {12.0, 0.0, 1.0});
}

TEST(ModelSphere, HoldsWhatTurns) {
  const Model model = spinningBox();
  const BoundingSphere sphere = boundingSphere(model);
  for (int ms = 0; ms < 250; ms += 10) {
    for (const MeshVertex& vertex : model.surfaces[0].mesh.vertices) {
      const glm::dvec3 p(modelFromPart(model.parts[0], milliseconds(ms)) *
                         glm::dvec4(glm::dvec3(vertex.position), 1.0));
      EXPECT_LE(glm::distance(p, sphere.centre), sphere.radiusMetres + 1e-6);
    }
  }
}

TEST(ModelSphere, OfASinglePartIsItsMeshs) {
  const Mesh box = boxMesh({1.0, 2.0, 3.0});
  const BoundingSphere sphere = boundingSphere(singlePartModel("box", box));
  EXPECT_EQ(sphere.centre, boundingSphere(box).centre);
  EXPECT_DOUBLE_EQ(sphere.radiusMetres, boundingSphere(box).radiusMetres);
}

TEST(ModelShortEdges, AreMeasuredWhereThePartsAre) {
  const Model fine = withShortEdges(spinningBox(), 1.0, 1'000'000);
  EXPECT_GT(fine.triangleCount(), 100u);
  for (const auto& t : fine.surfaces[0].mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& vertices = fine.surfaces[0].mesh.vertices;
      EXPECT_LE(glm::distance(vertices[t[i]].position, vertices[t[(i + 1) % 3]].position), 0.5001F);
    }
  }
  EXPECT_LT(withShortEdges(spinningBox(), 0.001, 500).triangleCount(), 600u);
}

}  // namespace
}  // namespace pleinair::scene
