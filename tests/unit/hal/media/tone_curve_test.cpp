#include "hal/media/tone_curve.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace pleinair::hal::libav {
namespace {

TEST(ToneCurve, KeepsShadowsAndMidTones) {
  // BT.2390-10: a peak of 1000 cd/m² on 203 is unchanged up to 1.5 · 0.5806 / 0.7518 - 0.5 of the
  // range in PQ, which is 92 cd/m².
  const ToneCurve curve(1000);
  for (const float nits : {0.5F, 5.0F, 40.0F, 90.0F}) {
    const float light = nits / static_cast<float>(kReferenceWhiteNits);
    EXPECT_NEAR(curve.map(light), light, 0.003F * light + 1e-4F) << nits;
  }
}

TEST(ToneCurve, RollsOffToThePeak) {
  const ToneCurve curve(1000);
  const float peak = 1000.0F / static_cast<float>(kReferenceWhiteNits);
  EXPECT_NEAR(curve.map(peak), 1.0F, 1e-3F);
  EXPECT_FLOAT_EQ(curve.map(2 * peak), 1.0F);
  float last = 0.0F;
  for (int i = 1; i <= 200; ++i) {
    const float mapped = curve.map(peak * static_cast<float>(i) / 200.0F);
    EXPECT_GE(mapped, last) << i;
    last = mapped;
  }
  // Reference white by hand: E1 = 0.7723, KS = 0.6585, T = 0.3333, E2 = 0.7384; 0.5551 in PQ.
  EXPECT_NEAR(curve.map(1.0F) * static_cast<float>(kReferenceWhiteNits), 160.0F, 3.0F);
}

TEST(ToneCurve, ChangesNothingWhereTheFilmIsNoBrighterThanWhite) {
  const ToneCurve curve(150);
  for (const float light : {0.01F, 0.3F, 0.9F}) EXPECT_FLOAT_EQ(curve.map(light), light);
}

TEST(ToneCurve, KeepsTheHueOfBrightColours) {
  const ToneCurve curve(1000);
  float red = 4.0F;
  float green = 2.0F;
  float blue = 1.0F;
  curve.apply(red, green, blue);
  EXPECT_LE(red, 1.0F);
  EXPECT_NEAR(green / red, 0.5F, 1e-4F);
  EXPECT_NEAR(blue / red, 0.25F, 1e-4F);
}

TEST(ToneCurve, BringsColoursIntoTheGamutWithTheirLuminance) {
  const ToneCurve curve(150);
  float red = -0.1F;
  float green = 0.5F;
  float blue = 0.1F;
  const auto luminance = [&] { return 0.2126F * red + 0.7152F * green + 0.0722F * blue; };
  const float before = luminance();
  curve.apply(red, green, blue);
  EXPECT_NEAR(std::min({red, green, blue}), 0.0F, 1e-6F);
  EXPECT_NEAR(luminance(), before, 1e-4F);
}

}  // namespace
}  // namespace pleinair::hal::libav
