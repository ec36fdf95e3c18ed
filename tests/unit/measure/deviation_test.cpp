#include "pipeline/measure/deviation.h"

#include <cmath>

#include <gtest/gtest.h>

#include "pipeline/measure/input/picture.h"
#include "pipeline/measure/input/sensor_noise.h"
#include "tests/unit/measure/measure_pictures.h"

namespace pleinair::measure {
namespace {

const cv::Size kSize(240, 240);

double rootOf(const Mean& mean) {
  return std::sqrt(*mean.value());
}

TEST(Deviation, DoesNotCountAToneCurve) {
  const cv::Mat3f input = noisePicture(kSize, 0.2, 1);
  cv::Mat3f output = input.clone();
  for (cv::Vec3f& pixel : output) {
    pixel = {0.5F * pixel[0] + 0.1F, -0.3F * pixel[1] + 0.8F, 1.2F * pixel[2]};
  }
  EXPECT_LT(rootOf(deviation(output, input)), 1e-4);
}

TEST(Deviation, IsTheRootMeanSquareOfWhatIsNotTheInputs) {
  const cv::Mat3f input = noisePicture(kSize, 0.2, 2);
  cv::Mat3f output;
  cv::add(input, noisePicture(kSize, 0.05, 3), output);
  EXPECT_NEAR(rootOf(deviation(output, input)), 0.05, 1e-3);
}

TEST(Deviation, OfAFlatPictureIsWhatThereIs) {
  const cv::Mat3f flat(kSize, cv::Vec3f(0.5F, 0.5F, 0.5F));
  EXPECT_NEAR(rootOf(deviation(noisePicture(kSize, 0.1, 4), flat)), 0.1, 1e-3);
  EXPECT_LT(rootOf(deviation(flat, flat)), 1e-6);
}

TEST(Detail, HalvesWithTheContrast) {
  const cv::Mat3f input = noisePicture(kSize, 0.2, 5);
  const double all = rootOf(meanSquare(highPass(input)));
  EXPECT_NEAR(rootOf(meanSquare(highPass(toned(input, 0.5)))) / all, 0.5, 1e-4);
}

TEST(Flicker, OfASensorIsTwoOverRootPiTimesItsNoise) {
  const cv::Mat3f scene(kSize, cv::Vec3f(0.5F, 0.5F, 0.5F));
  constexpr double kLevels = 4;
  const cv::Mat3f a = toFloat(withSensorNoise(scene, kLevels, 0).view());
  const cv::Mat3f b = toFloat(withSensorNoise(scene, kLevels, 1).view());
  // Mean |difference of two normals|, plus rounding to levels.
  const double expected = 2 / std::sqrt(M_PI) * std::sqrt(kLevels * kLevels + 1.0 / 12) / 255;
  EXPECT_NEAR(*absoluteDifference(a, b).value() / expected, 1.0, 0.01);
}

TEST(SensorNoise, IsTheSameOfOneSeed) {
  const cv::Mat3f scene = blobPicture(kSize, 6);
  const hal::Image a = withSensorNoise(scene, 2, 7);
  const hal::Image b = withSensorNoise(scene, 2, 7);
  EXPECT_TRUE(std::ranges::equal(a.view().planes[0].bytes, b.view().planes[0].bytes));
}

}  // namespace
}  // namespace pleinair::measure
