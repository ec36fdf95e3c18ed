#include "pipeline/overlay/part_shape.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "pipeline/scene/description/model_source.h"
#include "tests/unit/overlay/overlay_views.h"

namespace pleinair::overlay {
namespace {

scene::Model gearbox() {
  return scene::gearboxModel({.isClosed = true});
}

std::size_t partOf(const scene::Model& model, const char* name) {
  return static_cast<std::size_t>(scene::findPart(model, name) - model.parts.data());
}

TEST(PartShape, ABoltsAxisPointsOutOfItsHole) {
  const scene::Model model = gearbox();
  const PartShape bolt = shapeOf(model, partOf(model, "cover_bolt_1"));
  EXPECT_NEAR(bolt.axis.z, 1.0, 1e-9) << "up, out of the cover's flange";
  EXPECT_NEAR(bolt.halfLength, 0.5 * 0.0046 * 0.25 / 0.26, 0.002);
  EXPECT_GT(bolt.radius, 0.003);
  EXPECT_LT(bolt.radius, 0.008);
}

TEST(PartShape, ACouplingsAxisPointsToTheReader) {
  const scene::Model model = gearbox();
  const PartShape coupling = shapeOf(model, partOf(model, "input_coupling"));
  EXPECT_NEAR(coupling.axis.y, -1.0, 1e-9);
}

TEST(PartShape, AnotherOfItsAxesMayBeTheOneItMovesAlong) {
  const scene::Model model = gearbox();
  const PartShape bolt = shapeOf(model, partOf(model, "cover_bolt_1"));
  const PartShape aside = alongAxis(bolt, {-1.0, 0.0, 0.0});
  EXPECT_NEAR(glm::dot(aside.axis, bolt.axis), 0.0, 1e-9);
  EXPECT_NEAR(glm::dot(aside.axis, bolt.side), -1.0, 1e-9);
  EXPECT_NEAR(glm::dot(aside.axis, aside.side), 0.0, 1e-9);
  EXPECT_NEAR(aside.halfLength, bolt.radius, 0.15 * bolt.radius) << "it is round";
  EXPECT_NEAR(aside.radius, std::max(bolt.radius, bolt.halfLength), 0.15 * bolt.radius);
  EXPECT_EQ(alongAxis(aside, {0.0, 0.0, 1.0}).axis, bolt.axis);
  EXPECT_EQ(alongAxis(aside, {0.0, 0.0, 1.0}).halfLength, bolt.halfLength);
  EXPECT_EQ(alongAxis(bolt, {0.0, 0.0, -1.0}).axis, -bolt.axis);
}

TEST(PartShape, ItsBoxHoldsAllOfItInTheImage) {
  const scene::Model model = gearbox();
  const std::size_t index = partOf(model, "cover");
  const glm::dmat4 view = ahead(0.6, 20.0);
  const auto box = boxOf(shapeOf(model, index), view, testCamera());
  ASSERT_TRUE(box);
  const scene::ModelPart& part = model.parts[index];
  for (const auto& vertex : model.surfaces[part.firstSurface].mesh.vertices) {
    const glm::dvec3 at(view * part.modelFromPart * glm::dvec4(glm::dvec3(vertex.position), 1.0));
    const glm::dvec2 px = testCamera().project(at);
    EXPECT_TRUE(box->grown(1e-6).holds({px, px}));
  }
  EXPECT_GT(box->size().x, 100.0);
}

TEST(PartShape, BehindTheCameraThereIsNoBox) {
  const scene::Model model = gearbox();
  EXPECT_FALSE(boxOf(shapeOf(model, 0), ahead(-0.5), testCamera()));
}

TEST(PxBox, SharesAndOverlaps) {
  const PxBox a{{0, 0}, {10, 10}};
  EXPECT_DOUBLE_EQ(a.shared({{5, 5}, {20, 20}}), 25.0);
  EXPECT_DOUBLE_EQ(a.shared({{10, 0}, {20, 10}}), 0.0);
  EXPECT_FALSE(a.overlaps({{10, 0}, {20, 10}}));
  EXPECT_TRUE(a.overlaps({{9, 9}, {20, 10}}));
}

}  // namespace
}  // namespace pleinair::overlay
