// What single points of the picture are told of their motion, source by source, against plain
// arithmetic in double and finite differences.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gmock/gmock.h>

#include "pipeline/scene/builtin_box.h"
#include "tests/gpu/marks/marks_fixture.h"
#include "tests/gpu/marks/motion_questions.h"
#include "tests/oracles/feature_motion_oracle.h"

namespace pleinair::marks {
namespace {

using oracles::FeatureStep;
using oracles::FeatureTriangle;
using tracking::FeatureMotion;
using tracking::ImageMotion;

class ImageMotionTest : public MarksTest {
 protected:
  void SetUp() override {
    MarksTest::SetUp();
    if (IsSkipped()) return;
    library_.add(MotionQuestions::kShaders);
    questions_.emplace(library_);
    renderer_.emplace(library_, scene::Scene{});
    field_.emplace(library_, kSize);
    update({});
  }
  void TearDown() override {
    field_.reset();
    renderer_.reset();
    questions_.reset();
    MarksTest::TearDown();
  }

  void update(const ImageMotion& motion, const scene::PoseSet& poses = {}) {
    field_->update(compose(*renderer_, poses, motion), timer_);
  }
  std::vector<MotionAnswer> ask(const std::vector<glm::dvec2>& points, float layer = 0.0F) {
    std::vector<MotionQuestion> questions;
    for (const glm::dvec2 px : points) questions.push_back({.px = glm::vec2(px), .layer = layer});
    return questions_->ask(*field_, questions);
  }
  MotionAnswer askOne(glm::dvec2 px, float layer = 0.0F) { return ask({px}, layer).front(); }

  void useScene(scene::Scene scene) {
    renderer_.emplace(library_, scene);
    field_->reset();
  }

  glm::dvec2 anywhere(double border = 0.0) {
    std::uniform_real_distribution<double> x(border, kSize.width - border);
    std::uniform_real_distribution<double> y(border, kSize.height - border);
    return {x(random_), y(random_)};
  }
  double within(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  std::mt19937 random_{7};
  std::optional<MotionQuestions> questions_;
  std::optional<scene::ArFrameRenderer> renderer_;
  std::optional<MotionField> field_;
};

std::vector<FeatureMotion> told(std::span<const FeatureStep> steps, float errorPx = 0.05F) {
  std::vector<FeatureMotion> features;
  for (const FeatureStep& each : steps) {
    features.push_back({.id = static_cast<std::uint32_t>(features.size()),
                        .then = glm::vec2(each.then),
                        .now = glm::vec2(each.now),
                        .errorPx = errorPx});
  }
  return features;
}

/// As the shader is given it: in single precision.
glm::dvec2 single(glm::dvec2 px) {
  return glm::dvec2(glm::vec2(px));
}
FeatureStep rounded(const FeatureStep& step) {
  return {single(step.then), single(step.now)};
}

void expectMotion(const MotionAnswer& answer, const oracles::PointMotion& expected,
                  double tolerancePx, double tolerance, const std::string& where) {
  EXPECT_LT(glm::distance(glm::dvec2(answer.displacement), expected.displacement), tolerancePx)
      << where;
  for (int column = 0; column < 2; ++column) {
    EXPECT_LT(glm::distance(glm::dvec2(answer.jacobian[column]), expected.jacobian[column]),
              tolerance)
        << where << ", column " << column;
  }
}

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

TEST_F(ImageMotionTest, FlowIsInterpolatedAndItsSlopeIsTheJacobian) {
  constexpr hal::FrameSize kNodes{40, 30};
  const glm::dvec2 offset(1.3, -0.7);
  const glm::dmat2 slope(0.01, 0.004, -0.006, -0.012);  // column by column
  std::vector<glm::vec4> forward;
  for (int y = 0; y < kNodes.height; ++y) {
    for (int x = 0; x < kNodes.width; ++x) {
      const glm::dvec2 px = 8.0 * glm::dvec2(x + 0.5, y + 0.5);
      forward.emplace_back(glm::vec2(offset + slope * px), 0.2F, 0.0F);
    }
  }
  const std::vector<glm::vec4> backward(forward.size(), glm::vec4(9.0F, 9.0F, 0.2F, 0.0F));
  update(
      {.flow = {
           .nodes = kNodes, .stepPx = glm::vec2(8.0F), .forward = forward, .backward = backward}});
  std::vector<glm::dvec2> points;
  for (int i = 0; i < 200; ++i) points.push_back(single(anywhere(16.0)));
  const std::vector<MotionAnswer> answers = ask(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(answers[i].from(), MotionSource::kFlow);
    EXPECT_NEAR(answers[i].errorPx, 0.2F, 1e-4F);
    expectMotion(answers[i],
                 {.displacement = offset + slope * points[i], .jacobian = glm::dmat2(1.0) + slope},
                 1e-3, 1e-4, "point " + std::to_string(i));
  }
}

TEST_F(ImageMotionTest, TheHomographysJacobianIsItsDerivative) {
  const glm::dmat3 now(1.02, 0.03, 2e-5, -0.025, 0.99, -4e-5, 3.0, -2.0, 1.0);
  update({.picture = tracking::PictureHomography{.nowFromThen = now, .errorPx = 0.02}});
  std::vector<glm::dvec2> points;
  for (int i = 0; i < 200; ++i) points.push_back(single(anywhere()));
  const std::vector<MotionAnswer> answers = ask(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(answers[i].from(), MotionSource::kPicture);
    constexpr double kH = 1e-4;
    const glm::dvec2 px = points[i];
    const glm::dmat2 jacobian(
        (moved(now, px + glm::dvec2(kH, 0.0)) - moved(now, px - glm::dvec2(kH, 0.0))) / (2.0 * kH),
        (moved(now, px + glm::dvec2(0.0, kH)) - moved(now, px - glm::dvec2(0.0, kH))) / (2.0 * kH));
    expectMotion(answers[i], {.displacement = moved(now, px) - px, .jacobian = jacobian}, 2e-4,
                 1e-5, "point " + std::to_string(i));
  }
}

TEST_F(ImageMotionTest, BackwardLeadsBackFromWhereForwardLed) {
  const glm::dmat3 now(1.02, 0.03, 2e-5, -0.025, 0.99, -4e-5, 3.0, -2.0, 1.0);
  update({.picture = tracking::PictureHomography{.nowFromThen = now, .errorPx = 0.02}});
  for (int i = 0; i < 20; ++i) {
    const glm::dvec2 px = single(anywhere());
    const glm::dvec2 there = moved(now, px);
    const MotionAnswer back =
        questions_->ask(*field_, {{.px = glm::vec2(there), .backward = 1.0F}}).front();
    EXPECT_LT(glm::distance(single(there) + glm::dvec2(back.displacement), px), 3e-4);
  }
}

TEST_F(ImageMotionTest, NothingMovesWhereThePictureIsStill) {
  constexpr hal::FrameSize kFields{20, 15};
  std::vector<float> still(300, 0.02F);
  for (std::size_t i = 0; i < still.size(); ++i) {
    if (i % 20 >= 10) still[i] = tracking::StillFields::kNotStill;
  }
  const std::vector<glm::vec4> flow(1200, glm::vec4(0.05F, -0.03F, 0.3F, 0.0F));
  update({.flow = {.nodes = {40, 30}, .stepPx = glm::vec2(8.0F), .forward = flow, .backward = flow},
          .still = {.fields = kFields, .errorPx = still}});
  for (int i = 0; i < 50; ++i) {
    const MotionAnswer left = askOne({within(0.0, 159.0), within(0.0, 239.0)});
    EXPECT_EQ(left.from(), MotionSource::kStill);
    EXPECT_EQ(left.displacement, glm::vec2(0.0F));
    EXPECT_EQ(left.jacobian, glm::mat2(1.0F));
    const MotionAnswer right = askOne({within(161.0, 320.0), within(0.0, 239.0)});
    EXPECT_EQ(right.from(), MotionSource::kFlow);
  }
}

TEST_F(ImageMotionTest, TheSmallestPredictedErrorWins) {
  const glm::dmat3 shift(1, 0, 0, 0, 1, 0, 2.0, 1.0, 1.0);
  std::vector<FeatureStep> steps;
  for (int i = 0; i < 100; ++i) {
    const glm::dvec2 then = anywhere();
    steps.push_back({then, then + glm::dvec2(2.0, 1.0)});
  }
  const auto sourceWith = [&](float ofFeatures, double ofPicture, float ofFlow) {
    const std::vector<FeatureMotion> features = told(steps, ofFeatures);
    const std::vector<glm::vec4> flow(1200, glm::vec4(2.0F, 1.0F, ofFlow, 0.0F));
    update({.features = features,
            .picture = tracking::PictureHomography{.nowFromThen = shift, .errorPx = ofPicture},
            .flow = {
                .nodes = {40, 30}, .stepPx = glm::vec2(8.0F), .forward = flow, .backward = flow}});
    return askOne({150.0, 110.0}).from();
  };
  EXPECT_EQ(sourceWith(0.01F, 0.5, 0.5F), MotionSource::kFeatures);
  EXPECT_EQ(sourceWith(0.5F, 0.01, 0.5F), MotionSource::kPicture);
  EXPECT_EQ(sourceWith(0.5F, 0.5, 0.01F), MotionSource::kFlow);
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
          .picture = tracking::PictureHomography{.nowFromThen = left, .errorPx = 0.02}});
  const MotionAnswer inside = askOne({160.0, 120.0});
  EXPECT_EQ(inside.from(), MotionSource::kFeatures);
  EXPECT_NEAR(inside.displacement.x, 2.0F, 1e-3F);
  const MotionAnswer outside = askOne({20.0, 20.0});
  EXPECT_EQ(outside.from(), MotionSource::kPicture);
  EXPECT_NEAR(outside.displacement.x, -2.0F, 1e-3F);
}

TEST_F(ImageMotionTest, PlanesMoveByTheirPosesAndTurnByTheirDerivative) {
  scene::Scene scene;
  scene.planes.push_back({.name = "desk", .sizeMetres = {0.5, 0.5}});
  useScene(scene);
  const glm::dmat4 then =
      glm::rotate(glm::translate(glm::dmat4(1.0), {0.01, -0.02, 0.6}), 0.9, {1.0, 0.2, 0.1});
  const glm::dmat4 now =
      glm::rotate(glm::translate(glm::dmat4(1.0), {0.016, -0.017, 0.59}), 0.92, {1.0, 0.21, 0.1});
  update({}, {.cameraFromWorld = then});
  update({}, {.cameraFromWorld = now});
  const auto exact = [&](glm::dvec2 px) {
    const glm::dvec3 ray((px.x - 162.0) / 300.0, (px.y - 118.0) / 302.0, 1.0);
    const glm::dvec3 normal(then[2]);
    const double depth = glm::dot(glm::dvec3(then[3]), normal) / glm::dot(ray, normal);
    const glm::dvec4 onPlane = glm::inverse(then) * glm::dvec4(depth * ray, 1.0);
    return camera().project(glm::dvec3(now * onPlane));
  };
  for (int i = 0; i < 100; ++i) {
    const glm::dvec2 px = single({within(110.0, 210.0), within(80.0, 150.0)});
    const MotionAnswer answer = askOne(px);
    EXPECT_EQ(answer.from(), MotionSource::kPlane);
    constexpr double kH = 1e-3;
    const glm::dmat2 jacobian(
        (exact(px + glm::dvec2(kH, 0.0)) - exact(px - glm::dvec2(kH, 0.0))) / (2.0 * kH),
        (exact(px + glm::dvec2(0.0, kH)) - exact(px - glm::dvec2(0.0, kH))) / (2.0 * kH));
    expectMotion(answer, {.displacement = exact(px) - px, .jacobian = jacobian}, 2e-3, 1e-3,
                 "point " + std::to_string(i));
  }
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

TEST_F(ImageMotionTest, MotionOfASmallerFrameIsInPxOfTheFullPicture) {
  // A frame of 160 × 140 whose rows 10 to 130 fill the picture.
  const glm::dvec2 scale(0.5);
  const glm::dvec2 origin(0.0, 10.0);
  const std::array<FeatureStep, 3> steps{
      {{{40.0, 50.0}, {41.0, 50.5}}, {{80.0, 55.0}, {81.2, 55.4}}, {{60.0, 90.0}, {61.1, 90.8}}}};
  const std::vector<FeatureMotion> features = told(steps);
  const auto updateScaled = [&](const ImageMotion& motion) {
    scene::ArFrame frame = compose(*renderer_, {}, motion);
    motion_.frameSize = {160, 140};
    frame.pictureMovement =
        scene::PictureMovement{.motion = &motion_, .frameScale = scale, .frameOrigin = origin};
    field_->update(frame, timer_);
  };
  updateScaled({.features = features});
  const glm::dvec2 inFrame(61.0, 64.0);
  FeatureTriangle triangle{steps[0], steps[1], steps[2]};
  const oracles::PointMotion motion = oracles::triangleMotion(triangle, inFrame);
  expectMotion(askOne((inFrame - origin) / scale),
               {.displacement = motion.displacement / scale, .jacobian = motion.jacobian}, 1e-3,
               1e-4, "features");
  const glm::dmat3 now(1.02, 0.03, 2e-5, -0.025, 0.99, -4e-5, 3.0, -2.0, 1.0);
  updateScaled({.picture = tracking::PictureHomography{.nowFromThen = now, .errorPx = 0.02}});
  const glm::dvec2 there = (moved(now, inFrame) - origin) / scale;
  const glm::dvec2 here = (inFrame - origin) / scale;
  EXPECT_LT(glm::distance(here + glm::dvec2(askOne(here).displacement), there), 1e-3);
  EXPECT_NEAR(askOne(here).errorPx, 0.04F, 1e-4F);
}

TEST_F(ImageMotionTest, MotionSinceAnotherFrameIsRefused) {
  const glm::dmat3 shift(1, 0, 0, 0, 1, 0, 2.0, 1.0, 1.0);
  const ImageMotion motion{.picture =
                               tracking::PictureHomography{.nowFromThen = shift, .errorPx = 0.01}};
  update(motion);
  EXPECT_FALSE(field_->isCut());
  EXPECT_EQ(askOne({50.0, 50.0}).from(), MotionSource::kPicture);
  scene::ArFrame frame = compose(*renderer_, {}, motion);
  motion_.sinceSequence -= 1;
  field_->update(frame, timer_);
  EXPECT_TRUE(field_->isCut());
  EXPECT_EQ(askOne({50.0, 50.0}).from(), MotionSource::kUnknown);
  EXPECT_EQ(askOne({50.0, 50.0}).displacement, glm::vec2(0.0F));
  update(motion);
  EXPECT_FALSE(field_->isCut()) << "the next one follows";
  update({.isCut = true, .picture = motion.picture});
  EXPECT_TRUE(field_->isCut());
  EXPECT_EQ(askOne({50.0, 50.0}).from(), MotionSource::kUnknown) << "of a cut nothing holds";
}

TEST_F(ImageMotionTest, TheFieldSaysWhereThingsCameFrom) {
  const glm::dmat3 now(1.02, 0.03, 2e-5, -0.025, 0.99, -4e-5, 3.0, -2.0, 1.0);
  update({.picture = tracking::PictureHomography{.nowFromThen = now, .errorPx = 0.02}});
  const std::vector<float> texels = support::readRgba32f(field_->backward());
  const hal::FrameSize size = field_->backward().size();
  EXPECT_EQ(size, (hal::FrameSize{40, 30}));
  const glm::dmat3 then = glm::inverse(now);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const float* texel = &texels.at(static_cast<std::size_t>(4 * (y * size.width + x)));
      const glm::dvec2 here = 8.0 * glm::dvec2(x + 0.5, y + 0.5);
      const glm::dvec2 displacement = here - moved(then, here);
      EXPECT_LT(glm::distance(glm::dvec2(texel[0], texel[1]), displacement),
                1e-3 * glm::length(displacement) + 1e-3);
      EXPECT_NEAR(texel[2], 0.02F, 1e-4F);
      EXPECT_EQ(texel[3], static_cast<float>(MotionSource::kPicture));
    }
  }
}

}  // namespace
}  // namespace pleinair::marks
