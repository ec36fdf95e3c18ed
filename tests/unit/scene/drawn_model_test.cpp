#include "pipeline/scene/render/drawn_model.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/packing.hpp>
#include <gtest/gtest.h>

#include "pipeline/scene/builtin/builtin_box.h"
#include "pipeline/scene/builtin/builtin_gearbox.h"
#include "pipeline/scene/description/model_source.h"

namespace pleinair::scene {
namespace {

/// Two parts that share a mesh, one mirrored, of a mesh in two materials.
Model twins() {
  Model model = singlePartModel("left", boxMesh({0.1, 0.2, 0.3}));
  model.surfaces.push_back(
      {.mesh = withShortEdges(boxMesh({0.3, 0.2, 0.1}), 0.05F), .material = 1});
  model.materials.emplace_back();
  model.parts[0].surfaceCount = 2;
  model.parts.push_back(model.parts[0]);
  model.parts[1].name = "right";
  model.parts[1].modelFromPart = glm::scale(glm::dmat4(1.0), {1.0, -1.0, 1.0});
  numberParts(model);
  return model;
}

void expectSound(const Model& model) {
  const DrawnModel drawn(model);
  ASSERT_EQ(drawn.triangles.size(), model.triangleCount());
  ASSERT_EQ(drawn.rest.size(), drawn.attributes.size());
  std::uint32_t number = 0;
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    const ModelPart& part = model.parts[p];
    const bool mirrored = part.modelFromPart[1].y < 0.0;
    for (std::size_t s = 0; s < part.surfaceCount; ++s) {
      const Mesh& mesh = model.surfaces[part.firstSurface + s].mesh;
      for (const auto& corners : mesh.triangles) {
        const DrawnTriangle& triangle = drawn.triangles[number];
        ASSERT_EQ(triangle.corners[2], number);  // the provoking vertex is the triangle's own
        ASSERT_EQ(triangle.part, p);
        // the same corners, in the same turn, from any first one
        std::vector<glm::vec3> expected;
        for (const std::uint32_t corner : corners)
          expected.push_back(mesh.vertices[corner].position);
        if (mirrored) std::swap(expected[0], expected[1]);
        std::vector<glm::vec3> found;
        for (const std::uint32_t corner : triangle.corners) {
          found.push_back(drawn.rest[corner].position);
          ASSERT_EQ(drawn.rest[corner].firstMatrix, part.firstMatrix);
        }
        bool same = false;
        for (int turn = 0; turn < 3 && !same; ++turn) {
          std::rotate(found.begin(), found.begin() + 1, found.end());
          same = found == expected;
        }
        ASSERT_TRUE(same) << number;
        ++number;
      }
    }
  }
  // each triangle is drawn once, with its material
  std::size_t indices = 0;
  for (const DrawBatch& batch : drawn.batches) {
    ASSERT_EQ(batch.firstIndex, indices);
    indices += batch.indexCount;
  }
  EXPECT_EQ(indices, drawn.indices.size());
  EXPECT_EQ(indices, 3 * drawn.triangles.size());
  std::uint32_t posed = 0;
  for (const PoseRange& range : drawn.ranges) {
    ASSERT_EQ(range.firstVertex, posed);
    posed += range.vertexCount;
  }
  EXPECT_EQ(posed, drawn.rest.size());
}

TEST(DrawnModel, HasEachTriangleOnceUnderItsNumber) {
  expectSound(twins());
  expectSound(gearboxModel({}));
  expectSound(Model{});
}

TEST(DrawnModel, DrawsAMaterialAtOnce) {
  EXPECT_EQ(DrawnModel(twins()).batches.size(), 2u);
  const Model gearbox = gearboxModel({});
  EXPECT_LE(DrawnModel(gearbox).batches.size(), gearbox.materials.size());
}

TEST(DrawnModel, NeedsAboutAVertexATriangle) {
  const Model gearbox = gearboxModel({});
  const DrawnModel drawn(gearbox);
  EXPECT_LT(static_cast<double>(drawn.rest.size()), 1.3 * gearbox.triangleCount());
}

TEST(DrawnModel, LaysMorphTargetsBesideTheirVertices) {
  Model model = singlePartModel("box", boxMesh({0.1, 0.1, 0.1}));
  Mesh& mesh = model.surfaces[0].mesh;
  mesh.morphTargets.resize(2);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    // told from the position, to be found again
    mesh.morphTargets[0].positions.push_back(2.0F * mesh.vertices[i].position);
    mesh.morphTargets[1].positions.push_back(3.0F * mesh.vertices[i].position);
  }
  model.parts[0].firstWeight = 0;
  numberParts(model);
  const DrawnModel drawn(model);
  std::size_t checked = 0;
  for (const PoseRange& range : drawn.ranges) {
    ASSERT_EQ(range.targetCount, 2u);
    for (std::uint32_t i = 0; i < range.vertexCount; ++i, ++checked) {
      const glm::vec3 position = drawn.rest[range.firstVertex + i].position;
      const MorphDelta* deltas = &drawn.deltas[range.firstDelta + i];
      EXPECT_EQ(glm::vec3(deltas[0].position), 2.0F * position);
      EXPECT_EQ(glm::vec3(deltas[range.vertexCount].position), 3.0F * position);
    }
  }
  EXPECT_EQ(checked, drawn.rest.size());
}

TEST(Octahedral, KeepsDirections) {
  for (int i = 0; i < 2000; ++i) {
    const double z = 1.0 - 2.0 * (i + 0.5) / 2000.0;
    const double angle = 2.39996 * i;
    const double radius = std::sqrt(1.0 - z * z);
    const glm::vec3 unit(radius * std::cos(angle), radius * std::sin(angle), z);
    glm::vec2 flat = glm::unpackSnorm2x16(octahedral(unit));
    glm::vec3 back(flat, 1.0F - std::abs(flat.x) - std::abs(flat.y));
    if (back.z < 0.0F) {
      back = {(1.0F - std::abs(flat.y)) * (flat.x < 0.0F ? -1.0F : 1.0F),
              (1.0F - std::abs(flat.x)) * (flat.y < 0.0F ? -1.0F : 1.0F), back.z};
    }
    ASSERT_LT(glm::distance(glm::normalize(back), unit), 1e-4F) << i;
  }
}

}  // namespace
}  // namespace pleinair::scene
