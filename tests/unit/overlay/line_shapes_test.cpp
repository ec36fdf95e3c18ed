#include "pipeline/overlay/line_shapes.h"

#include <utility>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/overlay/overlay_views.h"

namespace pleinair::overlay {
namespace {

/// A disc that faces the camera.
PartShape disc() {
  PartShape shape;
  shape.halfLength = 0.004;
  shape.radius = 0.01;
  for (std::size_t i = 0; i < shape.corners.size(); ++i) {
    shape.corners.at(i) = {(i & 1) != 0 ? 0.01 : -0.01, (i & 2) != 0 ? 0.01 : -0.01,
                           (i & 4) != 0 ? 0.004 : -0.004};
  }
  return shape;
}

double turnOf(const LineShapes& shapes, const glm::dvec2& centre) {
  double sum = 0.0;
  for (const LineShape& each : shapes.all()) {
    if (each.isTriangle) continue;
    const glm::dvec2 a = glm::dvec2(each.a) - centre;
    const glm::dvec2 b = glm::dvec2(each.b) - centre;
    sum += a.x * b.y - a.y * b.x;
  }
  return sum;
}

TEST(LineShapes, UnscrewingTurnsCounterClockwiseInTheImage) {
  LineShapes shapes;
  shapes.addArrowOf({.kind = ArrowKind::kUnscrew}, disc(), ahead(0.4), testCamera(), 1.0, 0.0);
  ASSERT_GT(shapes.all().size(), 10U);
  EXPECT_LT(turnOf(shapes, {320, 240}), 0.0) << "image rows go down";
  shapes.clear();
  shapes.addArrowOf({.kind = ArrowKind::kScrew}, disc(), ahead(0.4), testCamera(), 1.0, 0.0);
  EXPECT_GT(turnOf(shapes, {320, 240}), 0.0);
}

TEST(LineShapes, AnArrowAroundAPartDoesNotCrossIt) {
  LineShapes shapes;
  shapes.addArrowOf({.kind = ArrowKind::kTurn}, disc(), ahead(0.4), testCamera(), 1.0, 0.3);
  const double radiusPx = 560.0 * 0.01 / 0.4;
  for (const LineShape& each : shapes.all()) {
    EXPECT_GT(glm::length(glm::dvec2(each.a) - glm::dvec2(320, 240)), radiusPx + each.halfWidthPx);
  }
}

TEST(LineShapes, PullingGoesOutAlongTheAxisAndPushingIn) {
  PartShape sideways = disc();
  sideways.axis = {1.0, 0.0, 0.0};
  sideways.side = {0.0, 1.0, 0.0};
  for (glm::dvec3& corner : sideways.corners) std::swap(corner.x, corner.z);
  const auto headOf = [&](ArrowKind kind) {
    LineShapes shapes;
    shapes.addArrowOf({.kind = kind}, sideways, ahead(0.4), testCamera(), 1.0, 0.0);
    EXPECT_EQ(shapes.all().size(), 2U);
    return glm::dvec2(shapes.all().back().a);
  };
  EXPECT_GT(headOf(ArrowKind::kPull).x, headOf(ArrowKind::kPush).x + 20.0);
  EXPECT_GT(headOf(ArrowKind::kPush).x, 320.0 + 560.0 * 0.004 / 0.4) << "beside the part";
}

TEST(LineShapes, AnArrowStaysInThePicture) {
  PartShape sideways = disc();
  sideways.axis = {1.0, 0.0, 0.0};
  sideways.side = {0.0, 1.0, 0.0};
  sideways.halfLength = 0.2;  // a long one, whose arrow would be long, too
  LineShapes shapes;
  const glm::dmat4 right = glm::translate(ahead(0.4), glm::dvec3(0.17, 0.0, 0.0));
  shapes.addArrowOf({.kind = ArrowKind::kPull}, sideways, right, testCamera(), 1.0, 0.0);
  ASSERT_EQ(shapes.all().size(), 2U);
  EXPECT_LT(shapes.all().back().a.x, 640.0F);
  ASSERT_EQ(shapes.arrowBoxes().size(), 1U);
  EXPECT_GT(shapes.arrowBoxes()[0].size().x, 15.0);
}

TEST(LineShapes, AnArrowTowardsTheViewerLiesBesideThePart) {
  LineShapes shapes;
  shapes.addArrowOf({.kind = ArrowKind::kPull}, disc(), ahead(0.4), testCamera(), 1.0, 0.0);
  const auto box = boxOf(disc(), ahead(0.4), testCamera());
  for (const LineShape& each : shapes.all()) {
    for (const glm::vec2& point : {each.a, each.b}) {
      EXPECT_FALSE(box->overlaps({glm::dvec2(point) - 0.1, glm::dvec2(point) + 0.1}));
    }
  }
}

TEST(LineShapes, ArrowsDoNotRunIntoOneAnother) {
  LineShapes shapes;
  PartShape beside = disc();
  const auto add = [&] {
    shapes.addArrowOf({.kind = ArrowKind::kTurn}, beside, ahead(0.4), testCamera(), 1.0, 0.0);
    return shapes.all().size();
  };
  const std::size_t one = add();
  beside.centre.x = 0.015;
  EXPECT_EQ(add(), one) << "too near";
  beside.centre.x = 0.06;
  EXPECT_EQ(add(), 2 * one);
}

TEST(LineShapes, NeighboursThatLeaveToEitherSideHaveAnArrowEach) {
  const auto arrowsOf = [](const glm::dvec3& axis, const glm::dvec3& other,
                           const glm::dvec3& apart) {
    LineShapes shapes;
    PartShape part = disc();
    part.side = {0.0, 0.0, 1.0};
    for (const auto& [along, sign] : {std::pair(axis, -0.5), {other, 0.5}}) {
      PartShape each = part;
      each.axis = along;
      each.centre = sign * apart;
      for (glm::dvec3& corner : each.corners) corner += each.centre;
      shapes.addArrowOf({.kind = ArrowKind::kPull}, each, ahead(0.4), testCamera(), 1.0, 0.0);
    }
    return shapes.arrowBoxes().size();
  };
  const glm::dvec3 right{1.0, 0.0, 0.0};
  EXPECT_EQ(arrowsOf(-right, right, 0.015 * right), 2U) << "21 px apart";
  EXPECT_EQ(arrowsOf(right, right, {0.0, 0.015, 0.0}), 1U) << "one beside the other";
}

TEST(LineShapes, KeepItsMemory) {
  LineShapes shapes;
  for (std::size_t i = 0; i < 2 * LineShapes::kMost; ++i) shapes.addLine({0, 0}, {1, 1}, 1.0);
  EXPECT_EQ(shapes.all().size(), LineShapes::kMost);
}

}  // namespace
}  // namespace pleinair::overlay
