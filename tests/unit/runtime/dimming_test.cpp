// A display that is dimmed, from the painter's pictures to the pixels that the card scans out,
// under a stepped clock.
#include "pipeline/runtime/output/dimming.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "hal/outputs/display/display_output.h"
#include "pipeline/runtime/live_pipeline.h"
#include "tests/support/fake_card.h"
#include "tests/support/live_simulation.h"

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;
using support::FakeCardSpec;
using support::SimulatedGpu;

TEST(Dim, MultipliesColoursAndKeepsAlpha) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = {256, 1}, .encoding = {}});
  const auto row = image.row(0, 0);
  for (std::size_t i = 0; i < 256; ++i) {
    row[4 * i] = static_cast<std::uint8_t>(i);
    row[4 * i + 1] = static_cast<std::uint8_t>(255 - i);
    row[4 * i + 2] = 255;
    row[4 * i + 3] = static_cast<std::uint8_t>(i);
  }
  for (const double share : {0.0, 0.1, 0.4, 0.5, 0.999, 1.0}) {
    hal::Image darker(image.format());
    dim(image.view(), brightnessOf(share), darker);
    const auto dark = darker.row(0, 0);
    for (std::size_t i = 0; i < 256; ++i) {
      const auto value = static_cast<double>(i);
      ASSERT_NEAR(dark[4 * i], share * value, 1.0) << share << " of " << i;
      ASSERT_NEAR(dark[4 * i + 1], share * (255 - value), 1.0) << share << " of " << i;
      ASSERT_NEAR(dark[4 * i + 2], share * 255, 1.0) << share << " of " << i;
      ASSERT_EQ(dark[4 * i + 3], i);
    }
  }
}

TEST(Dim, IsExactAtItsEnds) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = {3, 2}, .encoding = {}});
  std::ranges::fill(image.plane(0), std::uint8_t{255});
  dim(image.view(), kFullBrightness, image);
  for (const std::uint8_t each : image.plane(0)) EXPECT_EQ(each, 255);
  dim(image.view(), 0, image);
  for (std::size_t i = 0; i < image.plane(0).size(); ++i) {
    EXPECT_EQ(image.plane(0)[i], i % 4 == 3 ? 255 : 0);
  }
}

class DimmingPipeline : public testing::Test {
 protected:
  static constexpr std::uint8_t kPainted = 200;
  static constexpr std::uint32_t kBright = 0xC8C8C8C8;
  static constexpr std::uint32_t kDim = 0xC8646464;  ///< half of it; the fourth byte is not seen

  DimmingPipeline()
      : selector_(support::selectorOf(
            [](hal::Clock& clock) {
              return std::make_unique<support::PacedCamera>(support::PacedCameraOptions{}, clock);
            },
            live_.clock)) {
    live_.gpu.painted = kPainted;
  }

  void begin(FakeCardSpec spec = {}) {
    cards_.add(std::move(spec));
    live_.begin(selector_);
    OutputStageOptions options{.name = "display", .waiting = 16};
    options.keepsLastFrame = true;
    auto display = *hal::openDisplay(
        "display",
        {.placement = {},
         .blanking = {},
         .dimming = {.times = hal::display::DailyTimes{.from = 20h, .to = 23h}, .level = 0.5}},
        cards_, live_.clock);
    stage_ = &live_.addOutput(std::move(display), std::move(options));
  }
  void stepFor(hal::Duration duration) {
    for (const auto end = live_.clock.now() + duration; live_.clock.now() < end;) {
      stage_->step();
      live_.clock.advance(1ms);
    }
  }
  std::uint32_t lastPixel() const { return cards_.shown.back().firstPixel; }

  support::LiveSimulation live_;
  support::FakeCards cards_{live_.clock};
  hal::CameraSelector selector_;
  OutputStage* stage_ = nullptr;
};

TEST_F(DimmingPipeline, DarkensThePixelsInItsHoursAndBrightensThemAgain) {
  begin();
  live_.start();
  live_.runFor(3s);
  EXPECT_EQ(lastPixel(), kBright) << "a control";
  EXPECT_EQ(stage_->status().brightness, 1.0);

  cards_.localTime = 20h;
  const std::size_t before = cards_.shown.size();
  live_.runFor(8s);
  EXPECT_EQ(lastPixel(), kDim);
  EXPECT_EQ(stage_->status().brightness, 0.5);
  std::set<std::uint32_t> levels;
  for (std::size_t i = before + 1; i < cards_.shown.size(); ++i) {
    EXPECT_LE(cards_.shown[i].firstPixel & 0xFFU, cards_.shown[i - 1].firstPixel & 0xFFU);
    levels.insert(cards_.shown[i].firstPixel & 0xFFU);
  }
  EXPECT_GT(levels.size(), 80u) << "it fades";
  ASSERT_TRUE(stage_->lastFrame().has_value());
  EXPECT_EQ(stage_->lastFrame()->view().row(0, 0)[0], kPainted) << "the painting itself is not dim";

  cards_.localTime = 23h;
  live_.runFor(8s);
  EXPECT_EQ(lastPixel(), kBright);
  EXPECT_TRUE(stage_->status().addsUp());
}

TEST_F(DimmingPipeline, AnImplausibleClockDimsNothing) {
  cards_.localTime.reset();
  begin();
  live_.start();
  live_.runFor(10s);
  for (const auto& each : cards_.shown) EXPECT_EQ(each.firstPixel, kBright);
}

TEST_F(DimmingPipeline, AWaitingPictureThatStaysIsDimmedToo) {
  begin();
  auto paper = std::make_shared<hal::Image>(stage_->format().frame);
  std::ranges::fill(paper->plane(0), kPainted);
  stage_->showWaiting(paper);
  stepFor(1s);
  ASSERT_EQ(cards_.shown.size(), 1u);
  EXPECT_EQ(lastPixel(), kBright);
  cards_.localTime = 20h;
  stepFor(8s);
  EXPECT_EQ(lastPixel(), kDim);
  EXPECT_TRUE(stage_->status().isWaitingShown);
  const std::size_t shown = cards_.shown.size();
  stepFor(10s);
  EXPECT_EQ(cards_.shown.size(), shown) << "it is handed over for each step of the fade only";
  cards_.localTime = 12h;
  stepFor(8s);
  EXPECT_EQ(lastPixel(), kBright);
}

TEST_F(DimmingPipeline, TheFirstPictureInItsHoursIsDimAtOnce) {
  cards_.localTime = 21h;
  begin();
  live_.start();
  live_.runFor(1s);
  ASSERT_FALSE(cards_.shown.empty());
  for (const auto& each : cards_.shown) EXPECT_EQ(each.firstPixel, kDim);
}

TEST_F(DimmingPipeline, FramesThatTheGpuDrawsInPlaceAreCopiedMeanwhile) {
  live_.gpu.drawable = {hal::kLinearModifier};
  begin({.gpuModifiers = {hal::kLinearModifier}, .planeModifiers = {hal::kLinearModifier}});
  live_.start();
  const auto isDirect = [this] {
    return lastPixel() >= SimulatedGpu::kDrawn && lastPixel() < SimulatedGpu::kDrawn + 10'000;
  };
  live_.runFor(3s);
  EXPECT_TRUE(isDirect()) << "a control";
  cards_.localTime = 20h;
  live_.runFor(8s);
  EXPECT_EQ(lastPixel(), kDim);
  cards_.localTime = 12h;
  live_.runFor(8s);
  EXPECT_TRUE(isDirect());
  EXPECT_EQ(live_.gpu.imports, 1) << "what was imported is still good";
}

}  // namespace
}  // namespace pleinair::runtime
