// Directions of strokes that a scene or a file declares.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "pipeline/scene/builtin/builtin_box.h"
#include "pipeline/scene/models/declared_directions.h"
#include "tests/unit/scene/model_scene.h"

namespace pleinair::scene {
namespace {

using Source = StrokeDirection::Source;

class StrokeDirections : public ModelScene {
 protected:
  StrokeDirections() {
    writeTriangle("plain.glb", {});
    writeTriangle("brushed.glb", {1, 1, 0, 1, -1, -1, 0, 1, 1, 1, 0, -1});  // a line, of any sign
    writeTriangle("short.glb", {1, 0, 0, 1});
  }

  /// On z = 0.
  void writeTriangle(const std::string& file, const std::vector<float>& tangents) {
    GltfBuilder builder;
    builder.addMesh({0, 0, 0, 1, 0, 0, 0, 1, 0});
    if (!tangents.empty()) {
      const int accessor = builder.addFloats(tangents, "VEC4", 4);
      builder.root["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = accessor;
    }
    write(file, builder);
  }

  StrokeDirection directionOf(const std::string& source, const std::string& keys) {
    return sceneWith(source, keys).models[0].model->strokeDirection;
  }
};

TEST_F(StrokeDirections, AreThoseOfTheKey) {
  EXPECT_EQ(directionOf("builtin:box", "").source, Source::kCurvature);
  EXPECT_EQ(directionOf("brushed.glb", "").source, Source::kCurvature) << "only if asked for";
  EXPECT_EQ(directionOf("brushed.glb", "stroke_direction = \"tangents\"\n").source,
            Source::kTangents);
  EXPECT_EQ(directionOf("builtin:gear", "stroke_direction = \"picture\"\n").source,
            Source::kPicture);
  const StrokeDirection axis = directionOf("builtin:box", "stroke_direction = [0, 3, 4]\n");
  EXPECT_EQ(axis.source, Source::kAxis);
  EXPECT_NEAR(glm::distance(axis.axis, glm::vec3(0.0F, 0.6F, 0.8F)), 0.0F, 1e-6F);
}

TEST_F(StrokeDirections, RefusesWhatIsNone) {
  EXPECT_EQ(errorOf("builtin:box", "stroke_direction = \"curved\"\n"),
            "scene.toml:8: model[0].stroke_direction: found \"curved\", allowed: curvature, "
            "tangents, picture, or a direction [x, y, z]");
  EXPECT_EQ(errorOf("builtin:box", "stroke_direction = [0, 0, 0]\n"),
            "scene.toml:8: model[0].stroke_direction: has no length, allowed: a direction in the "
            "model's axes");
  EXPECT_THAT(errorOf("builtin:box", "stroke_direction = [0, 1]\n"),
              testing::StartsWith("scene.toml:8: model[0].stroke_direction: "));
  EXPECT_THAT(errorOf("builtin:box", "stroke_direction = true\n"),
              testing::StartsWith("scene.toml:8: model[0].stroke_direction: "));
  EXPECT_EQ(errorOf("plain.glb", "stroke_direction = \"tangents\"\n"),
            "scene.toml:8: model[0].stroke_direction: the model has no tangents, allowed: a glTF "
            "file with the attribute TANGENT");
  EXPECT_THAT(errorOf("builtin:box", "occluder = true\nstroke_direction = \"picture\"\n"),
              testing::StartsWith("scene.toml:9: model[0].stroke_direction: has no effect"));
  EXPECT_THAT(errorOf("short.glb", ""), testing::HasSubstr("TANGENT: has 1 elements, POSITION 3"));
}

TEST_F(StrokeDirections, ModelsOfOneSourceAndDirectionAreShared) {
  const Scene scene =
      sceneWith("builtin:box",
                "stroke_direction = [0, 0, 2]\n"
                "[[model]]\nname = \"b\"\nattach = \"tag:0\"\nsource = \"builtin:box\"\n"
                "stroke_direction = [0, 0, 1]\n"
                "[[model]]\nname = \"c\"\nattach = \"tag:0\"\nsource = \"builtin:box\"\n"
                "stroke_direction = \"curvature\"\n");
  EXPECT_EQ(scene.models[0].model, scene.models[1].model);
  EXPECT_NE(scene.models[0].model, scene.models[2].model);
  EXPECT_EQ(scene.models[2].model->strokeDirection.source, Source::kCurvature);
}

/// On each side of a box the axis lies in the side's plane; on those that it stands on it is none.
TEST_F(StrokeDirections, AnAxisIsSeenAlongTheSurface) {
  Model model = singlePartModel("box", boxMesh({0.1, 0.2, 0.3}));
  model.parts[0].modelFromPart = glm::rotate(glm::dmat4(1.0), 0.5, {1.0, 0.0, 0.0});
  const glm::vec3 axis = glm::normalize(glm::vec3(0.0F, 1.0F, 2.0F));
  model.strokeDirection = {.source = Source::kAxis, .axis = axis};
  const Mesh& mesh = model.surfaces[0].mesh;
  const std::vector<glm::vec3> found = declaredDirections(model, model.parts[0], 0);
  ASSERT_EQ(found.size(), mesh.triangles.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const glm::vec3 normal(model.parts[0].modelFromPart *
                           glm::dvec4(mesh.vertices[mesh.triangles[i][0]].normal, 0.0));
    const glm::vec3 along = axis - glm::dot(axis, normal) * normal;
    const glm::vec3 there(model.parts[0].modelFromPart * glm::dvec4(found[i], 0.0));
    if (glm::length(along) < 0.1F) {
      EXPECT_LT(glm::length(there), 0.01F);
    } else if (glm::length(along) > 0.3F) {
      EXPECT_NEAR(glm::length(there), 1.0F, 1e-4F);
      EXPECT_NEAR(std::abs(glm::dot(glm::normalize(along), there)), 1.0F, 1e-4F);
    }
  }
  model.strokeDirection.axis = glm::vec3(model.parts[0].modelFromPart * glm::dvec4(0, 0, 1, 0));
  int none = 0;
  for (const glm::vec3& each : declaredDirections(model, model.parts[0], 0)) {
    none += glm::length(each) < 1e-3F ? 1 : 0;
  }
  EXPECT_EQ(none, 4) << "the two triangles of its top and of its bottom";
}

TEST_F(StrokeDirections, TangentsHaveNoSign) {
  const Scene scene = sceneWith("brushed.glb", "stroke_direction = \"tangents\"\n");
  const Model& model = *scene.models[0].model;
  ASSERT_TRUE(declaresDirections(model, model.surfaces[0].mesh));
  const std::vector<glm::vec3> found = declaredDirections(model, model.parts[0], 0);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(glm::length(found[0]), 1.0F, 1e-4F);
  EXPECT_NEAR(std::abs(glm::dot(found[0], glm::normalize(glm::vec3(1, 1, 0)))), 1.0F, 1e-4F);
}

/// Halved edges have tangents too.
TEST_F(StrokeDirections, TangentsStayWhenAMeshIsSubdivided) {
  Scene scene = sceneWith("brushed.glb", "stroke_direction = \"tangents\"\n");
  const Model fine = withShortEdges(*scene.models[0].model, 0.3, 1000);
  ASSERT_GT(fine.surfaces[0].mesh.triangles.size(), 4U);
  for (const glm::vec3& each : declaredDirections(fine, fine.parts[0], 0)) {
    EXPECT_NEAR(std::abs(glm::dot(each, glm::normalize(glm::vec3(1, 1, 0)))), 1.0F, 1e-4F);
  }
}

TEST_F(StrokeDirections, ThePictureLeadsAlone) {
  Model model = singlePartModel("box", boxMesh({0.1, 0.2, 0.3}));
  EXPECT_FALSE(declaresDirections(model, model.surfaces[0].mesh));
  model.strokeDirection.source = Source::kPicture;
  ASSERT_TRUE(declaresDirections(model, model.surfaces[0].mesh));
  for (const glm::vec3& each : declaredDirections(model, model.parts[0], 0)) {
    EXPECT_EQ(glm::length(each), 0.0F);
  }
}

}  // namespace
}  // namespace pleinair::scene
