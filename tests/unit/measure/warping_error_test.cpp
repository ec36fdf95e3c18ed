#include "pipeline/measure/warping_error.h"

#include <gtest/gtest.h>

#include "pipeline/measure/input/picture.h"
#include "tests/unit/measure/measure_pictures.h"

namespace pleinair::measure {
namespace {

const cv::Size kSize(240, 200);
const cv::Point kShift(-3, -1);

MotionMap shiftMap() {
  return constantMap(kSize, cv::Point2d(kShift));
}

TEST(CarriedError, OfAPictureThatIsCarriedExactlyIsZero) {
  const cv::Mat3f canvas = noisePicture({260, 220}, 0.2, 1);
  const cv::Mat3f earlier = windowOf(canvas, {10, 10}, kSize);
  const cv::Mat3f later = windowOf(canvas, cv::Point(10, 10) - kShift, kSize);
  EXPECT_EQ(warpingError(earlier, warpedBack(later, shiftMap())).value(), 0.0);
  EXPECT_EQ(poppedShare(earlier, warpedBack(later, shiftMap())).value(), 0.0);
  EXPECT_GT(*warpingError(earlier, warpedBack(later, constantMap(kSize, {3, 1}))).value(), 0.07);
}

TEST(CarriedError, OfWhiteNoiseIsTwiceItsVariance) {
  constexpr double kSigma = 0.05;
  const Mean error = warpingError(noisePicture(kSize, kSigma, 2),
                                  warpedBack(noisePicture(kSize, kSigma, 3), shiftMap()));
  EXPECT_NEAR(*error.value(), 2 * kSigma * kSigma, 1e-4);
}

TEST(CarriedError, OfAConstantDifferenceIsItsSquareOverAllChannels) {
  const cv::Mat3f earlier(kSize, cv::Vec3f(0.2F, 0.3F, 0.4F));
  const cv::Mat3f later(kSize, cv::Vec3f(0.2F, 0.6F, 0.4F));
  EXPECT_NEAR(*warpingError(earlier, warpedBack(later, shiftMap())).value(), 0.09 / 3, 1e-6);
}

TEST(CarriedError, IsTakenWithinTheBorder) {
  cv::Mat3f later(kSize, cv::Vec3f());
  later.rowRange(0, kBorderPixels - 2).setTo(cv::Vec3f(1, 1, 1));
  const cv::Mat3f earlier(kSize, cv::Vec3f());
  const Mean error = warpingError(earlier, warpedBack(later, shiftMap()));
  EXPECT_EQ(error.value(), 0.0);
  EXPECT_EQ(error.weight, (240.0 - 80) * (200 - 80));
}

TEST(Popping, CountsPixelsOfMoreThan24LevelsInAnyChannel) {
  const cv::Mat3f earlier(kSize, cv::Vec3f(0.5F, 0.5F, 0.5F));
  const auto shareOf = [&](float levels) {
    cv::Mat3f later = earlier.clone();
    // A quarter of the area within the border.
    later(cv::Rect(40, 40, 80, 60)).setTo(cv::Vec3f(0.5F, 0.5F, 0.5F + levels / 255.0F));
    return *poppedShare(earlier, warpedBack(later, constantMap(kSize, {0, 0}))).value();
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
  const cv::Mat3f earlier = windowOf(canvas, {10, 10}, kSize);
  const cv::Mat3f later = windowOf(canvas, cv::Point(10, 10) - kShift, kSize);
  EXPECT_LT(highPassRatio(earlier, later), 1e-6);
  EXPECT_NEAR(highPassRatio(earlier, blobPicture(kSize, 5)), 1.0, 0.1);
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

}  // namespace
}  // namespace pleinair::measure
