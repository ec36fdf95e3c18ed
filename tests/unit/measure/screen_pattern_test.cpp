#include "pipeline/measure/screen_pattern.h"

#include <gtest/gtest.h>

#include "pipeline/measure/input/picture.h"
#include "pipeline/measure/voronoi_tiling.h"
#include "tests/unit/measure/measure_pictures.h"

namespace pleinair::measure {
namespace {

const cv::Size kSize(320, 240);

double correlation(const cv::Mat3f& a, const cv::Mat3f& b) {
  cv::Mat1b mask(kSize, 0);
  mask(innerRect(kSize)).setTo(255);
  return screenCorrelation(relativeGradient(greyOf(a)), relativeGradient(greyOf(b)), mask)
      .value_or(-2);
}

TEST(ScreenPattern, IsOneOfWhatStaysWhateverItsContrast) {
  const cv::Mat3f picture = blobPicture(kSize, 1);
  EXPECT_NEAR(correlation(picture, picture), 1.0, 1e-6);
  // At half the contrast the result is the same, apart from the constant in the mean.
  EXPECT_GT(correlation(picture, toned(picture, 0.5, 0.2)), 0.98);
}

TEST(ScreenPattern, IsNothingOfWhatMoves) {
  const cv::Mat3f canvas = blobPicture({360, 280}, 2);
  EXPECT_NEAR(correlation(windowOf(canvas, {0, 0}, kSize), windowOf(canvas, {15, 5}, kSize)), 0.0,
              0.05);
}

TEST(ScreenPattern, SeesTilesFixedToTheScreenAndNotFreshOnes) {
  const cv::Mat3f canvas = blobPicture({360, 280}, 3);
  const cv::Mat3f earlier = windowOf(canvas, {0, 0}, kSize);
  const cv::Mat3f later = windowOf(canvas, {15, 5}, kSize);
  const VoronoiTiling fixed(kSize, 0);
  EXPECT_GT(correlation(fixed.paint(earlier), fixed.paint(later)), 0.25);
  EXPECT_LT(correlation(fixed.paint(earlier), VoronoiTiling(kSize, 1).paint(later)), 0.18);
}

TEST(ScreenPattern, IsNotToldOfAFlatPicture) {
  const cv::Mat3f flat(kSize, cv::Vec3f(0.5F, 0.5F, 0.5F));
  EXPECT_EQ(correlation(flat, flat), -2);
}

TEST(VoronoiTiling, GivesEachTileTheMeanOfWhatItCovers) {
  const cv::Mat3f picture = noisePicture(kSize, 0.1, 4);
  const cv::Mat3f painted = VoronoiTiling(kSize, 5).paint(picture);
  const cv::Scalar before = cv::mean(picture);
  const cv::Scalar after = cv::mean(painted);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(before[c], after[c], 1e-5);
  // A tile has 64 px on average, so its mean has an eighth of the noise; larger tiles have less.
  cv::Scalar mean, deviation;
  cv::meanStdDev(painted, mean, deviation);
  EXPECT_NEAR(deviation[0], 0.1 / 8, 0.003);
}

TEST(VoronoiTiling, IsTheSameOfOneSeedAndAnotherOfAnother) {
  const cv::Mat3f picture = blobPicture(kSize, 6);
  const cv::Mat3f painted = VoronoiTiling(kSize, 7).paint(picture);
  EXPECT_EQ(cv::norm(painted, VoronoiTiling(kSize, 7).paint(picture), cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(painted, VoronoiTiling(kSize, 8).paint(picture), cv::NORM_INF), 0.05);
}

}  // namespace
}  // namespace pleinair::measure
