// A camera that goes sideways before two planes at different depths: the picture's homography is
// right for neither, and what the features about a point do otherwise makes up for it.
#include <algorithm>
#include <array>
#include <cstddef>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/gpu/marks/image_motion_fixture.h"
#include "tests/support/random_vectors.h"

namespace pleinair::marks {
namespace {

using oracles::FeatureStep;
using tracking::FeatureMotion;

constexpr int kFrames = 10;
constexpr double kNoisePx = 0.1;            // of a feature's motion, over both axes
constexpr double kPictureErrorPx = 0.07;    // as an estimator predicts it
constexpr glm::dvec2 kNearShift(2.3, 0.0);  // what is at the right is nearer …
constexpr glm::dvec2 kFarShift(2.0, 0.0);   // … than what is at the left
constexpr glm::dvec2 kPictureShift(2.15, 0.0);
constexpr double kBorderX = 160.0;
constexpr std::size_t kMany = 200;

class ParallaxTest : public ImageMotionTest {
 protected:
  static glm::dvec2 truth(glm::dvec2 px) { return px.x > kBorderX ? kNearShift : kFarShift; }

  std::vector<FeatureMotion> featuresThatMoveBy(std::size_t count, bool hasParallax) {
    std::normal_distribution<double> noise(0.0, kNoisePx / std::sqrt(2.0));
    std::vector<FeatureStep> steps;
    for (std::size_t i = 0; i < count; ++i) {
      const glm::dvec2 then = anywhere();
      const glm::dvec2 shift = hasParallax ? truth(then) : kPictureShift;
      steps.push_back({then, then + shift + support::randomVec2(noise, random_)});
    }
    return told(steps, static_cast<float>(kNoisePx));
  }

  void updateWith(const std::vector<FeatureMotion>& features) {
    const glm::dmat3 shift(1, 0, 0, 0, 1, 0, kPictureShift.x, kPictureShift.y, 1.0);
    update({.features = features,
            .picture = tracking::ImageHomography{.currentFromPrevious = shift,
                                                 .errorPx = kPictureErrorPx}});
  }

  /// Median of how far points, 30 px and more from where the planes meet, are from where they
  /// should be after kFrames frames.
  double medianDrift(std::size_t features) {
    std::vector<glm::dvec2> at;
    while (at.size() < 200) {
      const glm::dvec2 px = anywhere(40.0);
      if (std::abs(px.x - kBorderX) > 60.0) at.push_back(px);
    }
    std::vector<glm::dvec2> should = at;
    for (int i = 0; i < kFrames; ++i) {
      updateWith(featuresThatMoveBy(features, true));
      const std::vector<MotionAnswer> answers = ask(at);
      for (std::size_t k = 0; k < at.size(); ++k) {
        should[k] += truth(should[k]);
        at[k] += glm::dvec2(answers[k].displacement);
      }
    }
    std::vector<double> slips;
    for (std::size_t k = 0; k < at.size(); ++k) slips.push_back(glm::distance(at[k], should[k]));
    std::ranges::nth_element(slips, slips.begin() + 100);
    return slips[100];
  }
};

TEST_F(ParallaxTest, WhatTheNeighboursDoOtherwiseMakesUpForTheHomography) {
  EXPECT_NEAR(medianDrift(0), 1.5, 0.01) << "the homography alone, always to the same side";
  EXPECT_LT(medianDrift(kMany), 0.4) << "0.65 by the homography and the triangles of features";
}

TEST_F(ParallaxTest, PredictedErrorsKnowOfIt) {
  updateWith(featuresThatMoveBy(kMany, true));
  std::vector<glm::dvec2> points;
  while (points.size() < 300) {
    const glm::dvec2 px = single(anywhere(10.0));
    if (std::abs(px.x - kBorderX) > 30.0) points.push_back(px);
  }
  const std::vector<MotionAnswer> answers = ask(points);
  double actual = 0.0;
  double predicted = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec2 off = glm::dvec2(answers[i].displacement) - truth(points[i]);
    actual += glm::dot(off, off);
    predicted += static_cast<double>(answers[i].errorPx * answers[i].errorPx);
  }
  EXPECT_GT(std::sqrt(predicted / actual), 0.5);
  EXPECT_LT(std::sqrt(predicted / actual), 2.0);
}

TEST_F(ParallaxTest, FeaturesThatOnlyTrembleChangeNothing) {
  double off = 0.0;
  int fromPicture = 0;
  constexpr int kPoints = 200;
  updateWith(featuresThatMoveBy(kMany, false));
  for (int i = 0; i < kPoints; ++i) {
    const MotionAnswer answer = askOne(single(anywhere(10.0)));
    if (answer.from() != MotionSource::kPicture) continue;
    ++fromPicture;
    off += glm::distance(glm::dvec2(answer.displacement), kPictureShift);
  }
  EXPECT_GT(fromPicture, kPoints / 2);
  EXPECT_LT(off / fromPicture, 0.02) << "a fifth of what features tremble by";
}

}  // namespace
}  // namespace pleinair::marks
