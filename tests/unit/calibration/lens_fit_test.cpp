#include "pipeline/calibration/lens_fit.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/calibration/lens_uncertainty.h"
#include "tests/unit/calibration/calibration_views.h"

namespace pleinair::calibration {
namespace {

const Board kBoard(Checkerboard{9, 6, 0.025});
const tracking::CameraModel kBarrel({420, 424, 326, 235}, {.k1 = -0.3, .k2 = 0.09}, {640, 480});

TEST(LensFit, FindsTheLensFromCornersWithoutNoise) {
  const tracking::CameraModel camera(
      {900, 910, 652, 349}, {.k1 = -0.2, .k2 = 0.06, .p1 = 0.002, .p2 = -0.001, .k3 = 0.01},
      {1280, 720});
  const auto views = idealViews(kBoard, camera, support::calibrationPoses(kBoard, camera), 0.0);
  const auto fit = fitLens(views, camera.imageSize(), LensModel::kK1K2PK3);
  ASSERT_TRUE(fit);
  EXPECT_LT(fit->rmsPx, 1e-4);
  const LensVector found = parametersOf(fit->camera);
  const LensVector wanted = parametersOf(camera);
  for (std::size_t i = 0; i < kLensParameters; ++i) {
    EXPECT_NEAR(found.at(i), wanted.at(i), i < 4 ? 1e-2 : 1e-4) << i;
  }
}

TEST(LensFit, ItsErrorsAreAsLargeAsItsStandardDeviationsSay) {
  // The squared ratio of each free parameter's error to its standard deviation is 1 on average.
  constexpr int kTrials = 24;
  constexpr double kNoisePx = 0.1;
  const auto tour = support::calibrationPoses(kBoard, kBarrel);
  const LensVector wanted = parametersOf(kBarrel);
  LensVector sums{};
  double places = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto views =
        idealViews(kBoard, kBarrel, tour, kNoisePx, 1000u * static_cast<std::uint32_t>(trial + 1));
    const auto fit = fitLens(views, kBarrel.imageSize(), LensModel::kK1K2);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->rmsPx, kNoisePx * std::sqrt(2.0), 0.02);
    const LensVector found = parametersOf(fit->camera);
    for (std::size_t i = 0; i < 6; ++i) {
      const double error = (found.at(i) - wanted.at(i)) / fit->sigma(i);
      sums.at(i) += error * error / kTrials;
    }
    double worst = 0.0;
    for (const PlaceUncertainty& place : placeUncertainties(*fit))
      worst = std::max(worst, place.sigmaPx);
    places += support::rayErrorPx(kBarrel, fit->camera) / worst / kTrials;
  }
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_GT(sums.at(i), 0.4) << i;
    EXPECT_LT(sums.at(i), 2.0) << i;
  }
  // The largest error over the image is about the largest predicted one.
  EXPECT_GT(places, 0.4);
  EXPECT_LT(places, 2.0);
}

TEST(LensFit, FrontalViewsLeaveTheFocalLengthOpen) {
  const tracking::CameraModel camera({600, 600, 320, 240}, {}, {640, 480});
  const auto frontal = fitLens(idealViews(kBoard, camera, frontalTour(), 0.1), camera.imageSize(),
                               LensModel::kPinhole);
  const auto tilted =
      fitLens(idealViews(kBoard, camera, support::calibrationPoses(kBoard, camera), 0.1),
              camera.imageSize(), LensModel::kPinhole);
  ASSERT_TRUE(frontal && tilted);
  EXPECT_GT(frontal->sigma(0) / frontal->camera.intrinsics().fx, 0.03);
  EXPECT_LT(tilted->sigma(0) / tilted->camera.intrinsics().fx, 0.002);
}

TEST(LensFit, AWrongScaleOfTheBoardDoesNotChangeTheLens) {
  auto views = idealViews(kBoard, kBarrel, support::calibrationPoses(kBoard, kBarrel), 0.05);
  const auto fit = fitLens(views, kBarrel.imageSize(), LensModel::kK1K2);
  for (FitView& view : views) {
    for (auto& point : view) point.target *= 3.7;
  }
  const auto scaled = fitLens(views, kBarrel.imageSize(), LensModel::kK1K2);
  ASSERT_TRUE(fit && scaled);
  EXPECT_NEAR(scaled->camera.intrinsics().fx, fit->camera.intrinsics().fx, 1e-2);
  EXPECT_NEAR(scaled->camera.distortion().k1, fit->camera.distortion().k1, 1e-5);
}

TEST(LensCertainty, SeesALensThatFoldsBack) {
  EXPECT_FALSE(foldsInImage(kBarrel));
  // The radius falls beyond r² = 1 / (3 · 0.8), inside of the image's corners at r = 0.95.
  EXPECT_TRUE(foldsInImage({{420, 420, 320, 240}, {.k1 = -0.8}, {640, 480}}));
}

}  // namespace
}  // namespace pleinair::calibration
