#include "hal/cameras/synthetic/render/light_changes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tests/unit/hal/synthetic/captured.h"

namespace pleinair::hal::synthetic {
namespace {

/// Frames of 200 ms: the spotlight is on in 5 to 12, the exposure lowest at 30.
const std::vector<Image>& lightsFrames() {
  static const std::vector<Image> kFrames =
      capturedFrames(noiseFreeOptions(SyntheticShot::kLights), 46);
  return kFrames;
}

bool sameBytes(std::size_t a, std::size_t b) {
  return std::ranges::equal(bytesOf(lightsFrames()[a]), bytesOf(lightsFrames()[b]));
}

/// The mean green level of columns from … to, as shares of the width.
double meanGreen(std::size_t frame, double from, double to) {
  const ImageView image = lightsFrames()[frame].view();
  double sum = 0;
  int count = 0;
  for (int y = 0; y < 120; ++y) {
    for (int x = static_cast<int>(160 * from); x < static_cast<int>(160 * to); ++x, ++count) {
      sum += image.row(0, y)[3 * static_cast<std::size_t>(x) + 1];
    }
  }
  return sum / count;
}

TEST(SyntheticLights, ChangeNothingBetweenTheirChanges) {
  for (const std::size_t frame : {1U, 4U, 13U, 20U, 40U}) EXPECT_TRUE(sameBytes(0, frame)) << frame;
  EXPECT_FALSE(sameBytes(4, 5));
  EXPECT_TRUE(sameBytes(5, 12));
  EXPECT_TRUE(sameBytes(5, 45)) << "the next round";
  EXPECT_FALSE(sameBytes(12, 13));
}

TEST(SyntheticLights, AreTheStillShotWhileNoneIsOn) {
  const std::vector<Image> still = capturedFrames(noiseFreeOptions(SyntheticShot::kStill), 1);
  EXPECT_TRUE(std::ranges::equal(bytesOf(still[0]), bytesOf(lightsFrames()[0])));
}

TEST(SyntheticLights, SpotlightBrightensOnePart) {
  EXPECT_GT(meanGreen(5, 0.7, 1.0), 1.12 * meanGreen(4, 0.7, 1.0));
  EXPECT_LT(meanGreen(5, 0.0, 0.25), 1.02 * meanGreen(4, 0.0, 0.25));
  const auto off = bytesOf(lightsFrames()[4]);
  const auto on = bytesOf(lightsFrames()[5]);
  for (std::size_t i = 0; i < off.size(); ++i) EXPECT_GE(on[i] + 1, off[i]) << "never darker";
}

TEST(SyntheticLights, ExposureFallsByAQuarterAndRecovers) {
  constexpr auto kLights = SyntheticShot::kLights;
  EXPECT_EQ(exposureGain(kLights, 3.9), 1);
  EXPECT_NEAR(exposureGain(kLights, 5), 0.875, 1e-4);
  EXPECT_NEAR(exposureGain(kLights, 6), 0.75, 1e-4);
  EXPECT_NEAR(exposureGain(kLights, 7.9), 0.9875, 1e-4);
  EXPECT_NEAR(exposureGain(kLights, 8), 1, 1e-4);
  EXPECT_EQ(exposureGain(SyntheticShot::kStill, 6), 1);
  for (std::size_t frame = 21; frame <= 30; ++frame) {
    EXPECT_LT(meanGreen(frame, 0, 1), meanGreen(frame - 1, 0, 1));
    EXPECT_GT(meanGreen(frame + 10, 0, 1), meanGreen(frame + 9, 0, 1));
  }
  // A factor of 0.75 in light is about 0.88 in coded levels, everywhere.
  for (const double from : {0.0, 0.25, 0.5, 0.75}) {
    EXPECT_NEAR(meanGreen(30, from, from + 0.25) / meanGreen(0, from, from + 0.25), 0.875, 0.02);
  }
}

TEST(SyntheticLights, ChangeAtFrameTimesThatAreRounded) {
  EXPECT_FALSE(isSpotlightOn(SyntheticShot::kLights, 29 * 0.033333333));
  EXPECT_TRUE(isSpotlightOn(SyntheticShot::kLights, 30 * 0.033333333));
  EXPECT_TRUE(isSpotlightOn(SyntheticShot::kLights, 74 * 0.033333333));
  EXPECT_FALSE(isSpotlightOn(SyntheticShot::kLights, 75 * 0.033333333));
  EXPECT_FALSE(isSpotlightOn(SyntheticShot::kStill, 2));
}

TEST(SyntheticLights, MoveNothing) {
  SteppedClock clock;
  SyntheticOptions options = smallOptions();
  options.shot = SyntheticShot::kLights;
  const SyntheticCamera camera(options, clock);
  const FlowField flow = camera.flowField(4, 30, 8);
  for (const glm::vec2& px : flow.px) EXPECT_LT(std::abs(px.x) + std::abs(px.y), 1e-6F);
  EXPECT_EQ(std::ranges::count(flow.visible, 1), flow.size.pixels());
}

}  // namespace
}  // namespace pleinair::hal::synthetic
