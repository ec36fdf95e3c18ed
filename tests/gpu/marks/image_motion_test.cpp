// The motion at single points of the image, source by source, compared with plain arithmetic in
// double precision and finite differences. Features: feature_motion_test.cpp.
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/marks/image_motion_fixture.h"

namespace pleinair::marks {
namespace {

using oracles::FeatureStep;
using oracles::FeatureTriangle;
using tracking::FeatureMotion;
using tracking::ImageMotion;

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
  update({.picture = tracking::ImageHomography{.currentFromPrevious = now, .errorPx = 0.02}});
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
  update({.picture = tracking::ImageHomography{.currentFromPrevious = now, .errorPx = 0.02}});
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
    if (i % 20 >= 10) still[i] = tracking::StaticRegions::kNotStatic;
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
    update(
        {.features = features,
         .picture = tracking::ImageHomography{.currentFromPrevious = shift, .errorPx = ofPicture},
         .flow = {
             .nodes = {40, 30}, .stepPx = glm::vec2(8.0F), .forward = flow, .backward = flow}});
    return askOne({150.0, 110.0}).from();
  };
  EXPECT_EQ(sourceWith(0.01F, 0.5, 0.5F), MotionSource::kFeatures);
  EXPECT_EQ(sourceWith(0.5F, 0.01, 0.5F), MotionSource::kPicture);
  EXPECT_EQ(sourceWith(0.5F, 0.5, 0.01F), MotionSource::kFlow);
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
    frame.measuredMotion =
        scene::MeasuredMotion{.motion = &motion_, .frameScale = scale, .frameOrigin = origin};
    field_->update(frame);
  };
  updateScaled({.features = features});
  const glm::dvec2 inFrame(61.0, 64.0);
  FeatureTriangle triangle{steps[0], steps[1], steps[2]};
  const oracles::PointMotion motion = oracles::triangleMotion(triangle, inFrame);
  expectMotion(askOne((inFrame - origin) / scale),
               {.displacement = motion.displacement / scale, .jacobian = motion.jacobian}, 1e-3,
               1e-4, "features");
  const glm::dmat3 now(1.02, 0.03, 2e-5, -0.025, 0.99, -4e-5, 3.0, -2.0, 1.0);
  updateScaled({.picture = tracking::ImageHomography{.currentFromPrevious = now, .errorPx = 0.02}});
  const glm::dvec2 there = (moved(now, inFrame) - origin) / scale;
  const glm::dvec2 here = (inFrame - origin) / scale;
  EXPECT_LT(glm::distance(here + glm::dvec2(askOne(here).displacement), there), 1e-3);
  EXPECT_NEAR(askOne(here).errorPx, 0.04F, 1e-4F);
}

TEST_F(ImageMotionTest, MotionSinceAnotherFrameIsRefused) {
  const glm::dmat3 shift(1, 0, 0, 0, 1, 0, 2.0, 1.0, 1.0);
  const ImageMotion motion{
      .picture = tracking::ImageHomography{.currentFromPrevious = shift, .errorPx = 0.01}};
  update(motion);
  EXPECT_FALSE(field_->isCut());
  EXPECT_EQ(askOne({50.0, 50.0}).from(), MotionSource::kPicture);
  scene::ArFrame frame = compose(*renderer_, {}, motion);
  motion_.sinceSequence -= 1;
  field_->update(frame);
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
  update({.picture = tracking::ImageHomography{.currentFromPrevious = now, .errorPx = 0.02}});
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
