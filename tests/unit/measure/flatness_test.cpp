#include "pipeline/measure/flatness.h"

#include <cmath>

#include <gtest/gtest.h>

#include "pipeline/measure/input/true_motion.h"
#include "tests/unit/measure/measure_pictures.h"

namespace pleinair::measure {
namespace {

const cv::Size kSize(336, 336);

cv::Mat1f stripes(double period) {
  cv::Mat1f grey(kSize);
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      grey(y, x) = static_cast<float>(0.5 + 0.4 * std::sin(2 * M_PI * x / period));
    }
  }
  return grey;
}

TEST(Texture, OfACheckerboardKnowsItsSquares) {
  cv::Mat1f board(kSize);
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) board(y, x) = (x + y) % 2 == 0 ? 0.0F : 0.99F;
  }
  const TextureStatistics texture = textureOf(board);
  // One px along a row or column changes the square; one px along a diagonal does not.
  EXPECT_NEAR(texture.cooccurrences[0](0, 15), 0.25, 2e-3);
  EXPECT_NEAR(texture.cooccurrences[0](0, 0), 0.25, 2e-3);
  // Two px never change it.
  EXPECT_EQ(texture.cooccurrences[1](0, 15), 0.0);
  EXPECT_NEAR(texture.cooccurrences[1](0, 0) + texture.cooccurrences[1](15, 15), 1.0, 1e-9);
}

TEST(Texture, IsTheSameOfOnePictureAndFarFromAnothers) {
  const cv::Mat1f a = greyNoise(kSize, 0.15, 1);
  const TextureDifference none = differenceOf(textureOf(a), textureOf(a));
  EXPECT_EQ(none.cooccurrenceError, 0.0);
  EXPECT_EQ(none.spectrumError, 0.0);
  EXPECT_EQ(none.frequencyRatio, 1.0);
  EXPECT_LT(differenceOf(textureOf(a), textureOf(greyNoise(kSize, 0.15, 2))).cooccurrenceError,
            0.05);
  const cv::Mat1f dark(kSize, 0.1F);
  const cv::Mat1f bright(kSize, 0.9F);
  EXPECT_EQ(differenceOf(textureOf(dark), textureOf(bright)).cooccurrenceError, 1.0);
}

TEST(Texture, OfMarksThatGrowHasALowerFrequency) {
  const TextureDifference grown = differenceOf(textureOf(stripes(8)), textureOf(stripes(12)));
  EXPECT_NEAR(grown.frequencyRatio, 8.0 / 12.0, 0.05);
  EXPECT_GT(grown.spectrumError, 0.9);
}

TEST(FlatnessMeasures, KnowsTheScaleAndMarksThatKeepTheirSize) {
  const auto motion = homographyMotion(kSize, "zoom", [](std::uint64_t t) {
    const double s = std::pow(1.02, static_cast<double>(t));
    return cv::Matx33d(s, 0, 168 * (1 - s), 0, s, 168 * (1 - s), 0, 0, 1);
  });
  FlatnessMeasures measures;
  for (std::uint64_t i = 0; i < 21; ++i) {
    const double period = 8 * std::pow(1.02, static_cast<double>(i));
    cv::Mat3f input, output;
    cv::cvtColor(stripes(period), input, cv::COLOR_GRAY2RGB);
    cv::cvtColor(stripes(8), output, cv::COLOR_GRAY2RGB);
    measures.add(input, output);
    if (i >= 2 && i % 2 == 0) measures.follow(*motion->between(i - 2, i));
  }
  const auto flatness = measures.total();
  ASSERT_TRUE(flatness);
  EXPECT_NEAR(flatness->scale, std::pow(1.02, 20), 1e-3);
  EXPECT_NEAR(flatness->painting.frequencyRatio, 1.0, 1e-9);
  EXPECT_NEAR(flatness->input.frequencyRatio, std::pow(1.02, -16), 0.05);
}

TEST(FlatnessMeasures, SaysNothingWhereTheScaleStays) {
  FlatnessMeasures measures;
  for (int i = 0; i < 12; ++i) measures.add(blobPicture(kSize, 1), blobPicture(kSize, 1));
  EXPECT_FALSE(measures.total());
}

}  // namespace
}  // namespace pleinair::measure
