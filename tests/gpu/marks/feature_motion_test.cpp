// The motion at single points from the features around them, compared with the thesis' formula in
// double precision.
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gmock/gmock.h>

#include "pipeline/scene/builtin/builtin_box.h"
#include "tests/gpu/marks/image_motion_fixture.h"

namespace pleinair::marks {
namespace {

using oracles::FeatureStep;
using oracles::FeatureTriangle;
using tracking::FeatureMotion;

TEST_F(ImageMotionTest, TrianglesOfFeaturesMoveAsTheThesisSays) {
  int compared = 0;
  while (compared < 60) {
    FeatureTriangle triangle;
    const glm::dvec2 middle = anywhere(60.0);
    for (FeatureStep& each : triangle) {
      each.then = middle + glm::dvec2(within(-50.0, 50.0), within(-50.0, 50.0));
      each.now = each.then + glm::dvec2(within(-3.0, 3.0), within(-3.0, 3.0));
      each = rounded(each);
    }
    const glm::dvec2 px = single(middle + glm::dvec2(within(-20.0, 20.0), within(-20.0, 20.0)));
    const std::array<double, 3> at = oracles::barycentrics(triangle, px);
    const double far = at[0] * at[0] + at[1] * at[1] + at[2] * at[2];
    if (oracles::heightShare(triangle) < 0.3 || far > 2.9) continue;
    const std::vector<FeatureMotion> features = told(triangle);
    update({.features = features});
    const MotionAnswer answer = askOne(px);
    EXPECT_EQ(answer.from(), MotionSource::kFeatures);
    expectMotion(answer, oracles::triangleMotion(triangle, px), 2e-4, 2e-5,
                 "triangle " + std::to_string(compared));
    ++compared;
  }
}

TEST_F(ImageMotionTest, DegenerateTrianglesMoveAsTheBestSimilarity) {
  const glm::dvec2 a(100.0, 90.0);
  const glm::dvec2 along(17.0, 9.0);
  const auto turned = [&](glm::dvec2 px) {  // by 2°, zoomed by 1 %, and shifted
    const glm::dvec2 arm = px - a;
    const double c = 1.01 * std::cos(0.035);
    const double s = 1.01 * std::sin(0.035);
    return a + glm::dvec2(c * arm.x - s * arm.y, s * arm.x + c * arm.y) + glm::dvec2(0.8, -0.4);
  };
  const std::array<std::array<glm::dvec2, 3>, 4> places{{
      {a, a + along, a + 2.0 * along},                            // in a line
      {a, a + along, a + 2.0 * along + glm::dvec2(0.01, -0.02)},  // nearly so
      {a, a, a + along},                                          // two in one place
      {a, a + glm::dvec2(40.0, 0.0), a + glm::dvec2(21.0, 0.5)},  // flat
  }};
  for (std::size_t i = 0; i < places.size(); ++i) {
    FeatureTriangle triangle;
    for (std::size_t k = 0; k < 3; ++k)
      triangle.at(k) = rounded({places.at(i).at(k), turned(places.at(i).at(k))});
    const std::vector<FeatureMotion> features = told(triangle);
    update({.features = features});
    const glm::dvec2 px(109.0, 121.0);
    const MotionAnswer answer = askOne(px);
    EXPECT_EQ(answer.from(), MotionSource::kFeatures);
    expectMotion(answer, oracles::similarityMotion(triangle, px), 1e-3, 1e-4,
                 "case " + std::to_string(i));
    EXPECT_LT(glm::distance(px + glm::dvec2(answer.displacement), turned(px)), 2e-3) << i;
  }
}

TEST_F(ImageMotionTest, FeaturesInOnePlaceOnlyShift) {
  const FeatureStep step{{80.0, 60.0}, {81.5, 59.25}};
  const std::array<FeatureStep, 3> same{step, step, step};
  const std::vector<FeatureMotion> features = told(same);
  update({.features = features});
  const MotionAnswer answer = askOne({120.0, 130.0});
  EXPECT_EQ(answer.displacement, glm::vec2(1.5F, -0.75F));
  EXPECT_EQ(answer.jacobian, glm::mat2(1.0F));
}

TEST_F(ImageMotionTest, PointsFarOutsideATriangleDoNotFlyOff) {
  // A small triangle whose corners tremble by a tenth of a px, and a point 150 px away.
  const std::array<FeatureStep, 3> steps{{{{100.0, 100.0}, {100.1, 100.0}},
                                          {{106.0, 100.0}, {105.9, 100.1}},
                                          {{103.0, 105.0}, {103.0, 104.9}}}};
  const std::vector<FeatureMotion> features = told(steps, 0.1F);
  update({.features = features});
  const MotionAnswer near = askOne({103.0, 102.0});
  const MotionAnswer far = askOne({240.0, 160.0});
  EXPECT_LT(glm::length(far.displacement), 5.0F);
  EXPECT_GT(far.errorPx, glm::length(far.displacement) / 3.0F) << "it says that it guesses";
  EXPECT_GT(far.errorPx, 5.0F * near.errorPx);
}

TEST_F(ImageMotionTest, TheNearestThreeOfManyCount) {
  std::vector<FeatureStep> steps;
  for (int i = 0; i < 200; ++i) {
    const glm::dvec2 then = anywhere();
    const glm::dvec2 arm = then - glm::dvec2(160.0, 120.0);
    steps.push_back(rounded({then, then + glm::dvec2(0.01 * arm.y, -0.008 * arm.x) +
                                       glm::dvec2(within(-0.05, 0.05), within(-0.05, 0.05))}));
  }
  const std::vector<FeatureMotion> features = told(steps);
  update({.features = features});
  std::vector<glm::dvec2> points;
  for (int i = 0; i < 300; ++i) points.push_back(single(anywhere(10.0)));
  const std::vector<MotionAnswer> answers = ask(points);
  int compared = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const FeatureTriangle nearest = oracles::nearestThree(steps, points[i]);
    const std::array<double, 3> at = oracles::barycentrics(nearest, points[i]);
    const double far = at[0] * at[0] + at[1] * at[1] + at[2] * at[2];
    if (oracles::heightShare(nearest) < 0.3 || far > 2.9) continue;
    expectMotion(answers[i], oracles::triangleMotion(nearest, points[i]), 5e-4, 1e-4,
                 "point " + std::to_string(i));
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

TEST_F(ImageMotionTest, WhatTheFeaturesAroundContradictIsNotBelieved) {
  // The whole picture goes left; what is about the middle goes right.
  const glm::dmat3 left(1, 0, 0, 0, 1, 0, -2.0, 0.0, 1.0);
  std::vector<FeatureStep> steps;
  for (int i = 0; i < 200; ++i) {
    const glm::dvec2 then = anywhere();
    const bool isInside = glm::distance(then, glm::dvec2(160.0, 120.0)) < 60.0;
    steps.push_back({then, then + glm::dvec2(isInside ? 2.0 : -2.0, 0.0)});
  }
  const std::vector<FeatureMotion> features = told(steps);
  update({.features = features,
          .picture = tracking::ImageHomography{.currentFromPrevious = left, .errorPx = 0.02}});
  const MotionAnswer inside = askOne({160.0, 120.0});
  EXPECT_EQ(inside.from(), MotionSource::kFeatures);
  EXPECT_NEAR(inside.displacement.x, 2.0F, 1e-3F);
  const MotionAnswer outside = askOne({20.0, 20.0});
  EXPECT_EQ(outside.from(), MotionSource::kPicture);
  EXPECT_NEAR(outside.displacement.x, -2.0F, 1e-3F);
}

TEST_F(ImageMotionTest, FeaturesOfARealObjectAndOfWhatIsBehindItNeverMix) {
  scene::Scene scene;
  scene::SceneModel box = placed(scene::BoxSource{{0.12, 0.12, 0.01}});
  box.attachFromModel = glm::translate(glm::dmat4(1.0), {0.0, 0.0, 0.5});
  box.isOccluder = true;
  scene.models.push_back(std::move(box));
  useScene(scene);
  const scene::PoseSet poses{.cameraFromWorld = glm::dmat4(1.0)};
  update({}, poses);
  // It covers about x 126…198, y 82…154, and goes right while the rest goes left.
  std::vector<FeatureStep> steps;
  for (int i = 0; i < 250; ++i) {
    const glm::dvec2 now = anywhere();
    const bool isOn = now.x > 126.0 && now.x < 198.0 && now.y > 82.0 && now.y < 154.0;
    steps.push_back({now - glm::dvec2(isOn ? 3.0 : -3.0, 0.0), now});
  }
  const std::vector<FeatureMotion> features = told(steps);
  update({.features = features}, poses);
  const float layer = static_cast<float>(scene::kRealObject + 1U);
  for (const double y : {90.0, 118.0, 146.0}) {
    const MotionAnswer beside = askOne({121.0, y});
    EXPECT_NEAR(beside.displacement.x, -3.0F, 1e-3F) << "beside it, at " << y;
    const MotionAnswer on = askOne({128.0, y}, layer);
    EXPECT_NEAR(on.displacement.x, 3.0F, 1e-3F) << "on it, at " << y;
  }
}

}  // namespace
}  // namespace pleinair::marks
