#include "pipeline/measure/image_measures.h"

#include <cmath>

#include <gtest/gtest.h>

#include "pipeline/measure/input/picture.h"
#include "pipeline/measure/negative_controls.h"
#include "tests/unit/measure/measure_pictures.h"

namespace pleinair::measure {
namespace {

const cv::Size kSmall(240, 200);
const cv::Point kShift(-3, -1);

MotionMap shiftMap() {
  return constantMap(kSmall, cv::Point2d(kShift));
}

TEST(CarriedError, OfAPictureThatIsCarriedExactlyIsZero) {
  const cv::Mat3f canvas = noisePicture({260, 220}, 0.2, 1);
  const cv::Mat3f earlier = windowOf(canvas, {10, 10}, kSmall);
  const cv::Mat3f later = windowOf(canvas, cv::Point(10, 10) - kShift, kSmall);
  EXPECT_EQ(warpingError(earlier, warpedBack(later, shiftMap())).value(), 0.0);
  EXPECT_EQ(poppedShare(earlier, warpedBack(later, shiftMap())).value(), 0.0);
  EXPECT_GT(*warpingError(earlier, warpedBack(later, constantMap(kSmall, {3, 1}))).value(), 0.07);
}

TEST(CarriedError, OfWhiteNoiseIsTwiceItsVariance) {
  constexpr double kSigma = 0.05;
  const Mean error = warpingError(noisePicture(kSmall, kSigma, 2),
                                  warpedBack(noisePicture(kSmall, kSigma, 3), shiftMap()));
  EXPECT_NEAR(*error.value(), 2 * kSigma * kSigma, 1e-4);
}

TEST(CarriedError, OfAConstantDifferenceIsItsSquareOverAllChannels) {
  const cv::Mat3f earlier(kSmall, cv::Vec3f(0.2F, 0.3F, 0.4F));
  const cv::Mat3f later(kSmall, cv::Vec3f(0.2F, 0.6F, 0.4F));
  EXPECT_NEAR(*warpingError(earlier, warpedBack(later, shiftMap())).value(), 0.09 / 3, 1e-6);
}

TEST(CarriedError, IsTakenWithinTheBorder) {
  cv::Mat3f later(kSmall, cv::Vec3f());
  later.rowRange(0, kBorderPixels - 2).setTo(cv::Vec3f(1, 1, 1));
  const cv::Mat3f earlier(kSmall, cv::Vec3f());
  const Mean error = warpingError(earlier, warpedBack(later, shiftMap()));
  EXPECT_EQ(error.value(), 0.0);
  EXPECT_EQ(error.weight, (240.0 - 80) * (200 - 80));
}

TEST(Popping, CountsPixelsOfMoreThan24LevelsInAnyChannel) {
  const cv::Mat3f earlier(kSmall, cv::Vec3f(0.5F, 0.5F, 0.5F));
  const auto shareOf = [&](float levels) {
    cv::Mat3f later = earlier.clone();
    // A quarter of the area within the border.
    later(cv::Rect(40, 40, 80, 60)).setTo(cv::Vec3f(0.5F, 0.5F, 0.5F + levels / 255.0F));
    return *poppedShare(earlier, warpedBack(later, constantMap(kSmall, {0, 0}))).value();
  };
  EXPECT_EQ(shareOf(25), 0.25);
  EXPECT_EQ(shareOf(24), 0.0);
  EXPECT_EQ(shareOf(-25), 0.25);
}

double highPassRatio(const cv::Mat3f& earlier, const cv::Mat3f& later) {
  const cv::Mat3f a = highPass(earlier);
  const cv::Mat3f b = highPass(later);
  const Mean own = warpingError(a, warpedBack(b, shiftMap(), {}, kHighPassReach));
  const Mean wrong =
      warpingError(a, warpedBack(b, shiftMap(), {kMisalignedX, kMisalignedY}, kHighPassReach));
  return *ratio(own.value(), wrong.value());
}

TEST(HighPassError, IsNothingForCarriedMarksAndOneForStrangers) {
  const cv::Mat3f canvas = blobPicture({260, 220}, 4);
  const cv::Mat3f earlier = windowOf(canvas, {10, 10}, kSmall);
  const cv::Mat3f later = windowOf(canvas, cv::Point(10, 10) - kShift, kSmall);
  EXPECT_LT(highPassRatio(earlier, later), 1e-6);
  EXPECT_NEAR(highPassRatio(earlier, blobPicture(kSmall, 5)), 1.0, 0.1);
}

TEST(HighPass, TakesAwayWhatIsCoarseAndKeepsWhatIsFine) {
  cv::Mat3f ramp(200, 200);
  for (int y = 0; y < ramp.rows; ++y) {
    for (int x = 0; x < ramp.cols; ++x) ramp(y, x) = cv::Vec3f::all(0.004F * static_cast<float>(x));
  }
  EXPECT_LT(cv::norm(highPass(ramp)(innerRect(ramp.size())), cv::NORM_INF), 1e-4);
  const cv::Mat3f noise = noisePicture({200, 200}, 0.1, 6);
  cv::Scalar mean, deviation;
  cv::meanStdDev(highPass(noise), mean, deviation);
  EXPECT_NEAR(deviation[0], 0.1, 0.003);
}

const cv::Size kWide(320, 240);
const cv::Point kLongShift(-15, -5);

Mean lasting(const cv::Mat3f& earlier, const cv::Mat3f& later, cv::Point shift = kLongShift) {
  return lastingMarks(greyOf(earlier),
                      warpedBack(greyOf(later), constantMap(kWide, cv::Point2d(shift))));
}

TEST(LastingMarks, AreAllOfAPatternThatIsCarried) {
  const cv::Mat3f canvas = blobPicture({360, 280}, 1);
  const cv::Mat3f earlier = windowOf(canvas, {20, 20}, kWide);
  const Mean found = lasting(earlier, windowOf(canvas, cv::Point(20, 20) - kLongShift, kWide));
  EXPECT_GT(found.weight, 100);
  EXPECT_EQ(found.value(), 1.0);
  // A mark one px away is still found; one four px away is not.
  EXPECT_EQ(*lasting(earlier, windowOf(canvas, cv::Point(21, 20) - kLongShift, kWide)).value(),
            1.0);
  EXPECT_LT(*lasting(earlier, windowOf(canvas, cv::Point(24, 20) - kLongShift, kWide)).value(),
            0.1);
}

TEST(LastingMarks, AreNoneOfStrangers) {
  const Mean found = lasting(blobPicture(kWide, 2), blobPicture(kWide, 3));
  EXPECT_GT(found.weight, 100);
  EXPECT_LT(*found.value(), 0.02);
}

TEST(LastingMarks, AreNotToldOfAFlatPicture) {
  const cv::Mat3f flat(kWide, cv::Vec3f(0.5F, 0.5F, 0.5F));
  EXPECT_FALSE(lasting(flat, flat).value());
}

TEST(LastingMarks, AreThreeHundredAtTheMost) {
  const cv::Mat3f wide = noisePicture({900, 700}, 0.2, 4);
  const Mean found =
      lastingMarks(greyOf(wide), warpedBack(greyOf(wide), constantMap(wide.size(), {0, 0})));
  EXPECT_EQ(found.weight, 300);
}

const cv::Size kSquare(240, 240);

double rootOf(const Mean& mean) {
  return std::sqrt(*mean.value());
}

TEST(Deviation, DoesNotCountAToneCurve) {
  const cv::Mat3f input = noisePicture(kSquare, 0.2, 1);
  cv::Mat3f output = input.clone();
  for (cv::Vec3f& pixel : output) {
    pixel = {0.5F * pixel[0] + 0.1F, -0.3F * pixel[1] + 0.8F, 1.2F * pixel[2]};
  }
  EXPECT_LT(rootOf(deviation(output, input)), 1e-4);
}

TEST(Deviation, IsTheRootMeanSquareOfWhatIsNotTheInputs) {
  const cv::Mat3f input = noisePicture(kSquare, 0.2, 2);
  cv::Mat3f output;
  cv::add(input, noisePicture(kSquare, 0.05, 3), output);
  EXPECT_NEAR(rootOf(deviation(output, input)), 0.05, 1e-3);
}

TEST(Deviation, OfAFlatPictureIsWhatThereIs) {
  const cv::Mat3f flat(kSquare, cv::Vec3f(0.5F, 0.5F, 0.5F));
  EXPECT_NEAR(rootOf(deviation(noisePicture(kSquare, 0.1, 4), flat)), 0.1, 1e-3);
  EXPECT_LT(rootOf(deviation(flat, flat)), 1e-6);
}

TEST(Detail, HalvesWithTheContrast) {
  const cv::Mat3f input = noisePicture(kSquare, 0.2, 5);
  const double all = rootOf(meanSquare(highPass(input)));
  EXPECT_NEAR(rootOf(meanSquare(highPass(toned(input, 0.5)))) / all, 0.5, 1e-4);
}

TEST(Flicker, OfASensorIsTwoOverRootPiTimesItsNoise) {
  const cv::Mat3f scene(kSquare, cv::Vec3f(0.5F, 0.5F, 0.5F));
  constexpr double kLevels = 4;
  const cv::Mat3f a = toFloat(withSensorNoise(scene, kLevels, 0).view());
  const cv::Mat3f b = toFloat(withSensorNoise(scene, kLevels, 1).view());
  // Mean |difference of two normals|, plus rounding to levels.
  const double expected = 2 / std::sqrt(M_PI) * std::sqrt(kLevels * kLevels + 1.0 / 12) / 255;
  EXPECT_NEAR(*absoluteDifference(a, b).value() / expected, 1.0, 0.01);
}

TEST(SensorNoise, IsTheSameOfOneSeed) {
  const cv::Mat3f scene = blobPicture(kSquare, 6);
  const hal::Image a = withSensorNoise(scene, 2, 7);
  const hal::Image b = withSensorNoise(scene, 2, 7);
  EXPECT_TRUE(std::ranges::equal(a.view().planes[0].bytes, b.view().planes[0].bytes));
}

double correlation(const cv::Mat3f& a, const cv::Mat3f& b) {
  cv::Mat1b mask(kWide, 0);
  mask(innerRect(kWide)).setTo(255);
  return screenCorrelation(relativeGradient(greyOf(a)), relativeGradient(greyOf(b)), mask)
      .value_or(-2);
}

TEST(ScreenPattern, IsOneOfWhatStaysWhateverItsContrast) {
  const cv::Mat3f picture = blobPicture(kWide, 1);
  EXPECT_NEAR(correlation(picture, picture), 1.0, 1e-6);
  // At half the contrast the result is the same, apart from the constant in the mean.
  EXPECT_GT(correlation(picture, toned(picture, 0.5, 0.2)), 0.98);
}

TEST(ScreenPattern, IsNothingOfWhatMoves) {
  const cv::Mat3f canvas = blobPicture({360, 280}, 2);
  EXPECT_NEAR(correlation(windowOf(canvas, {0, 0}, kWide), windowOf(canvas, {15, 5}, kWide)), 0.0,
              0.05);
}

TEST(ScreenPattern, SeesTilesFixedToTheScreenAndNotFreshOnes) {
  const cv::Mat3f canvas = blobPicture({360, 280}, 3);
  const cv::Mat3f earlier = windowOf(canvas, {0, 0}, kWide);
  const cv::Mat3f later = windowOf(canvas, {15, 5}, kWide);
  const VoronoiTiling fixed(kWide, 0);
  EXPECT_GT(correlation(fixed.paint(earlier), fixed.paint(later)), 0.25);
  EXPECT_LT(correlation(fixed.paint(earlier), VoronoiTiling(kWide, 1).paint(later)), 0.18);
}

TEST(ScreenPattern, IsNotToldOfAFlatPicture) {
  const cv::Mat3f flat(kWide, cv::Vec3f(0.5F, 0.5F, 0.5F));
  EXPECT_EQ(correlation(flat, flat), -2);
}

}  // namespace
}  // namespace pleinair::measure
