#include "pipeline/scene/models/simplified_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "pipeline/scene/builtin/builtin_box.h"
#include "pipeline/scene/builtin/builtin_gear.h"
#include "pipeline/scene/builtin/builtin_gearbox.h"
#include "pipeline/scene/builtin/builtin_moving.h"
#include "pipeline/scene/builtin/shapes.h"
#include "tests/unit/scene/solid_checks.h"

namespace pleinair::scene {
namespace {

const Mesh& meshOf(const Model& model) {
  return model.surfaces.front().mesh;
}

/// Ericson, "Real-Time Collision Detection", 2004, section 5.1.5.
double distanceTo(const std::array<glm::dvec3, 3>& triangle, const glm::dvec3& point) {
  const auto& [a, b, c] = triangle;
  const auto toSegment = [&](const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 along = to - from;
    const double t = std::clamp(glm::dot(point - from, along) / glm::dot(along, along), 0.0, 1.0);
    return glm::distance(point, from + t * along);
  };
  const double toEdges = std::min({toSegment(a, b), toSegment(b, c), toSegment(c, a)});
  const glm::dvec3 normal = glm::normalize(areaVector(triangle));
  const double above = glm::dot(point - a, normal);
  const glm::dvec3 foot = point - above * normal;
  const auto isInside = [&](const glm::dvec3& from, const glm::dvec3& to) {
    return glm::dot(glm::cross(to - from, foot - from), normal) >= 0.0;
  };
  const bool isOver = isInside(a, b) && isInside(b, c) && isInside(c, a);
  return isOver ? std::min(std::abs(above), toEdges) : toEdges;
}

/// The largest distance of a surface from another: of the corners, edges' middles and middles of at
/// most 400 triangles.
double largestDistance(const Mesh& from, const Mesh& to) {
  double largest = 0.0;
  const std::size_t step = 1 + from.triangles.size() / 400;
  for (std::size_t t = 0; t < from.triangles.size(); t += step) {
    const auto [a, b, c] = cornersOf(from, t);
    for (const glm::dvec3& point :
         {a, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), (a + b + c) / 3.0}) {
      double nearest = std::numeric_limits<double>::max();
      for (std::size_t u = 0; u < to.triangles.size(); ++u) {
        nearest = std::min(nearest, distanceTo(cornersOf(to, u), point));
      }
      largest = std::max(largest, nearest);
    }
  }
  return largest;
}

double distanceBetween(const Mesh& a, const Mesh& b) {
  return std::max(largestDistance(a, b), largestDistance(b, a));
}

/// Upright, of radius 1 m and 4 m high; each side has `segments` corners.
Model pillar(std::size_t segments) {
  const std::array<glm::dvec2, 4> section{{{0.0, 0.0}, {1.0, 0.0}, {1.0, 4.0}, {0.0, 4.0}}};
  return singlePartModel("pillar", turned(section, false, segments));
}

TEST(SimplifiedModel, HasNoTrianglesInFlatFaces) {
  const Model box = singlePartModel("box", withShortEdges(boxMesh({1.0, 2.0, 3.0}), 0.1F));
  ASSERT_GT(box.triangleCount(), 1000u);
  const Model fewer = simplified(box);
  EXPECT_LT(fewer.triangleCount(), 60u);
  EXPECT_NEAR(volumeOf(meshOf(fewer)), 6.0, 1e-4);
  EXPECT_LT(distanceBetween(meshOf(box), meshOf(fewer)), 1e-4);
  EXPECT_EQ(wrongNormals(meshOf(fewer), 0.9999), 0) << "edges are still hard";
}

TEST(SimplifiedModel, StaysWithinAThousandthOfTheModelsWidth) {
  const Model fine = pillar(720);
  const double width = 2.0 * boundingSphere(fine).radiusMetres;
  const Model fewer = simplified(fine);
  EXPECT_LT(fewer.triangleCount(), fine.triangleCount() / 5);
  const double apart = distanceBetween(meshOf(fine), meshOf(fewer));
  EXPECT_LT(apart, width / 1000.0);
  EXPECT_GT(apart, width / 10000.0) << "it could have fewer";
  EXPECT_EQ(unmatchedEdges(meshOf(fewer)), 0) << "it is still closed";
  EXPECT_EQ(wrongNormals(meshOf(fewer), 0.9), 0);
}

TEST(SimplifiedModel, IsTheSameWhereNothingIsTooFine) {
  const Model coarse = pillar(24);
  EXPECT_EQ(simplified(coarse).triangleCount(), coarse.triangleCount());
}

TEST(SimplifiedModel, MeasuresSurfacesWhereThePartsAre) {
  Model near = pillar(720);
  // As large as before, from a mesh a hundred times as small.
  Model scaled = near;
  for (MeshVertex& vertex : scaled.surfaces[0].mesh.vertices) vertex.position *= 0.01F;
  scaled.parts[0].modelFromPart = glm::scale(glm::dmat4(1.0), glm::dvec3(100.0));
  numberParts(scaled);
  const auto apart = static_cast<double>(simplified(near).triangleCount());
  EXPECT_NEAR(simplified(scaled).triangleCount(), apart, 0.05 * apart);
}

TEST(SimplifiedModel, LeavesASmallPartItsForm) {
  const Model fine = pillar(120);
  Model both = pillar(120);
  both.surfaces.push_back({.mesh = boxMesh({400.0, 1.0, 1.0})});
  both.parts.push_back({.name = "beam", .firstSurface = 1, .surfaceCount = 1});
  numberParts(both);
  const Model fewer = simplified(both);
  EXPECT_LT(distanceBetween(meshOf(fine), meshOf(fewer)), 4.5 / 250.0);
  EXPECT_GT(fewer.parts[0].triangleCount, 40u);
}

TEST(SimplifiedModel, KeepsVerticesAsTheyWere) {
  Model fine = pillar(720);
  Mesh& mesh = fine.surfaces[0].mesh;
  for (const MeshVertex& vertex : mesh.vertices) {
    mesh.tangents.push_back(glm::cross(vertex.normal, glm::vec3(0.3F, 0.5F, 0.8F)));
  }
  const Model fewer = simplified(fine);
  const Mesh& left = meshOf(fewer);
  ASSERT_LT(left.triangles.size(), mesh.triangles.size());
  ASSERT_EQ(left.tangents.size(), left.vertices.size());
  for (std::size_t i = 0; i < left.vertices.size(); ++i) {
    const bool isOld = std::ranges::any_of(mesh.vertices, [&](const MeshVertex& old) {
      return old.position == left.vertices[i].position && old.normal == left.vertices[i].normal;
    });
    EXPECT_TRUE(isOld);
    EXPECT_EQ(left.tangents[i], glm::cross(left.vertices[i].normal, glm::vec3(0.3F, 0.5F, 0.8F)));
  }
}

TEST(SimplifiedModel, NumbersWhatIsLeft) {
  const Model fine = gearboxModel({});
  const Model fewer = simplified(fine);
  EXPECT_LT(fewer.triangleCount(), fine.triangleCount() * 3 / 4);
  ASSERT_EQ(fewer.parts.size(), fine.parts.size());
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < fewer.parts.size(); ++i) {
    EXPECT_EQ(fewer.parts[i].name, fine.parts[i].name);
    EXPECT_EQ(fewer.parts[i].firstTriangle, next);
    next += fewer.parts[i].triangleCount;
    EXPECT_EQ(fewer.parts[i].firstMatrix, fine.parts[i].firstMatrix);
  }
  EXPECT_EQ(fewer.triangleCount(), next);
}

TEST(SimplifiedModel, LeavesToothFlanksWhereTheyMesh) {
  const Mesh gear = gearMesh({});
  const Model fewer = simplified(singlePartModel("gear", gear));
  EXPECT_LT(meshOf(fewer).triangles.size(), gear.triangles.size() * 9 / 10);
  const double width = 2.0 * boundingSphere(gear).radiusMetres;
  EXPECT_LT(distanceBetween(gear, meshOf(fewer)), width / 1000.0);
  EXPECT_EQ(unmatchedEdges(meshOf(fewer)), 0);
}

/// Surfaces whose looks depend on their vertices.
class SimplifiedModelAlone : public testing::Test {
 protected:
  Model fine = pillar(720);
  Mesh& mesh() { return fine.surfaces[0].mesh; }
  void expectAlone() { EXPECT_EQ(meshOf(simplified(fine)).triangles, mesh().triangles); }
};

TEST_F(SimplifiedModelAlone, WithATexture) {
  fine.textures.emplace_back();
  fine.materials[0].texture = 0;
  expectAlone();
}

TEST_F(SimplifiedModelAlone, WithColours) {
  mesh().vertices[7].colour = {1.0F, 0.0F, 0.0F, 1.0F};
  expectAlone();
}

TEST_F(SimplifiedModelAlone, WithASkin) {
  mesh().joints.resize(mesh().vertices.size());
  expectAlone();
}

TEST_F(SimplifiedModelAlone, WithMorphTargets) {
  const Model ball = ballModel({});
  EXPECT_EQ(simplified(ball).triangleCount(), ball.triangleCount());
}

TEST_F(SimplifiedModelAlone, WithNormalsThatAreNotItsForms) {
  const Model flat = singlePartModel("box", withShortEdges(boxMesh({1.0, 2.0, 3.0}), 0.1F));
  Model bumpy = flat;
  for (MeshVertex& vertex : bumpy.surfaces[0].mesh.vertices) {
    const float angle = 40.0F * vertex.position.x + 30.0F * vertex.position.y;
    vertex.normal =
        glm::normalize(vertex.normal + 1.5F * glm::vec3(std::cos(angle), std::sin(angle), 0.5F));
  }
  EXPECT_EQ(simplified(bumpy).triangleCount(), bumpy.triangleCount());
}

TEST(SimplifiedModel, TakesModelsWithoutTriangles) {
  EXPECT_EQ(simplified(singlePartModel("nothing", {})).triangleCount(), 0u);
  EXPECT_EQ(simplified(Model{}).triangleCount(), 0u);
  Mesh point;
  point.vertices.resize(3);
  point.triangles.push_back({0, 1, 2});
  EXPECT_EQ(simplified(singlePartModel("point", point)).triangleCount(), 1u);
}

}  // namespace
}  // namespace pleinair::scene
