// Waiting pictures on an output that lends surfaces, under a stepped clock: a camera of 30 frames a
// second, a painter that takes 20 ms, a simulated display.
#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "pipeline/runtime/live_pipeline.h"
#include "tests/support/fake_display_output.h"
#include "tests/support/live_simulation.h"

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;
using support::FakeDisplay;
using support::FakeDisplayOutput;

constexpr hal::FrameSize kSize{8, 6};
constexpr std::uint8_t kPaper = 240;

std::shared_ptr<const hal::Image> paper(hal::FrameSize size = kSize, std::uint8_t level = kPaper) {
  auto picture = std::make_shared<hal::Image>(
      hal::FrameFormat{.pixelFormat = hal::PixelFormat::kRgba8, .size = size, .encoding = {}});
  std::ranges::fill(picture->plane(0), level);
  return picture;
}

class WaitingPictureStage : public testing::Test {
 protected:
  WaitingPictureStage()
      : selector_(support::selectorOf(
            [this](hal::Clock& clock) {
              return std::make_unique<support::PacedCamera>(camera_, clock);
            },
            live_.clock)) {}

  OutputStage& begin(std::uint64_t frames) {
    camera_.frames = frames;
    live_.begin(selector_);
    OutputStageOptions options{.name = "display", .waiting = 16};
    options.keepsLastFrame = true;
    options.request = {.size = kSize, .framePeriod = {}};
    options.reopen = [this]() -> hal::Result<std::unique_ptr<hal::Output>> {
      return std::make_unique<FakeDisplayOutput>(display_, live_.clock);
    };
    return live_.addOutput(std::make_unique<FakeDisplayOutput>(display_, live_.clock),
                           std::move(options));
  }
  void stepFor(OutputStage& stage, hal::Duration duration) {
    for (const auto end = live_.clock.now() + duration; live_.clock.now() < end;) {
      stage.step();
      live_.clock.advance(1ms);
    }
  }
  static std::uint8_t level(const FakeDisplay::Shown& shown) {
    return static_cast<std::uint8_t>(shown.firstPixel);
  }

  support::LiveSimulation live_;
  support::PacedCameraOptions camera_;
  hal::CameraSelector selector_;
  FakeDisplay display_;
};

TEST_F(WaitingPictureStage, IsShownBeforeThereIsAPainter) {
  OutputStage& stage = begin(30);
  stepFor(stage, 100ms);
  EXPECT_TRUE(display_.shown.empty()) << "a control: nothing is shown by itself";
  stage.showWaiting(paper());
  EXPECT_TRUE(stage.status().isWaitingDue);
  stepFor(stage, 40ms);
  ASSERT_EQ(display_.shown.size(), 1u);
  EXPECT_EQ(level(display_.shown.front()), kPaper);
  EXPECT_TRUE(stage.status().isWaitingShown);
  EXPECT_TRUE(stage.isIdle());
  EXPECT_EQ(live_.gpu.made, 0);
  EXPECT_EQ(stage.status().submitted, 0u) << "it is no frame";
  EXPECT_TRUE(stage.status().addsUp());
}

TEST_F(WaitingPictureStage, GivesWayToFramesThatFadeInAndArriveWhole) {
  OutputStage& stage = begin(60);
  stage.showWaiting(paper());
  stepFor(stage, 40ms);
  live_.start();
  live_.drain();
  ASSERT_EQ(display_.shown.size(), 61u);
  for (std::size_t i = 1; i < display_.shown.size(); ++i) {
    EXPECT_LE(level(display_.shown[i]), level(display_.shown[i - 1])) << i;
  }
  EXPECT_GT(level(display_.shown[1]), 200) << "hardly anything of the first frame, which is black";
  EXPECT_EQ(display_.shown.back().firstPixel, 0u);
  const auto firstWhole = std::ranges::find(display_.shown, 0u, &FakeDisplay::Shown::firstPixel);
  EXPECT_GT(firstWhole->time - display_.shown[1].time, 400ms);
  EXPECT_LE(firstWhole->time - display_.shown[1].time, FadeIn::kDuration + 34ms);
  EXPECT_FALSE(stage.status().isWaitingShown);
  EXPECT_TRUE(live_.chain->ledger().counts().addsUp());
}

TEST_F(WaitingPictureStage, ReplacesWithoutAFadeWhereThatIsAsked) {
  OutputStage& stage = begin(10);
  stage.showWaiting(paper(), false);
  stepFor(stage, 40ms);
  live_.start();
  live_.drain();
  ASSERT_EQ(display_.shown.size(), 11u);
  EXPECT_EQ(display_.shown[1].firstPixel, 0u);
}

TEST_F(WaitingPictureStage, WaitsForTheFramesThatAreOnTheirWay) {
  OutputStage& stage = begin(30);
  live_.start();
  live_.runFor(500ms);
  stage.showWaiting(paper());
  live_.drain();
  live_.runFor(100ms);
  ASSERT_EQ(display_.shown.size(), 31u);
  EXPECT_EQ(level(display_.shown.back()), kPaper);
  for (std::size_t i = 0; i + 1 < display_.shown.size(); ++i) {
    EXPECT_EQ(display_.shown[i].firstPixel, 0u) << i;
  }
}

TEST_F(WaitingPictureStage, IsForgottenWhenItIsCancelled) {
  OutputStage& stage = begin(30);
  stage.showWaiting(paper());
  stage.cancelWaiting();
  stepFor(stage, 100ms);
  EXPECT_TRUE(display_.shown.empty());
}

TEST_F(WaitingPictureStage, OfAnotherSizeIsDropped) {
  OutputStage& stage = begin(30);
  stage.showWaiting(paper({6, 8}));
  stepFor(stage, 100ms);
  EXPECT_TRUE(display_.shown.empty());
  EXPECT_FALSE(stage.status().isWaitingDue);
  EXPECT_FALSE(stage.status().isFailed);
}

TEST_F(WaitingPictureStage, NoticesThatTheDisplayIsGoneMeanwhileAndIsForgotten) {
  OutputStage& stage = begin(30);
  stage.showWaiting(paper());
  stepFor(stage, 100ms);
  display_.isLost = true;
  stepFor(stage, 200ms);
  EXPECT_TRUE(stage.status().isFailed);
  EXPECT_FALSE(stage.status().isWaitingShown);
  display_.isLost = false;
  stepFor(stage, 2s);
  EXPECT_FALSE(stage.status().isFailed);
  EXPECT_EQ(stage.status().starts, 2u);
  EXPECT_EQ(display_.shown.size(), 1u) << "another one is for the caller to draw";
}

TEST_F(WaitingPictureStage, TakesAnotherStreamThatThePainterFollows) {
  OutputStage& stage = begin(60);
  stage.showWaiting(paper());
  stepFor(stage, 40ms);
  constexpr hal::FrameSize kOther{12, 6};
  stage.reconfigure({.size = kOther, .framePeriod = {}});
  EXPECT_FALSE(stage.isReconfigured());
  stepFor(stage, 40ms);
  EXPECT_TRUE(stage.isReconfigured());
  EXPECT_EQ(display_.reconfigured, 1);
  EXPECT_EQ(display_.opened, 1) << "it was not opened anew";
  EXPECT_EQ(stage.format().frame.size, kOther);
  live_.start();
  live_.drain();
  ASSERT_EQ(display_.shown.size(), 61u);
  EXPECT_EQ(display_.shown.back().size, kOther);
}

TEST_F(WaitingPictureStage, TellsThatTheDisplayDidNotTakeIt) {
  OutputStage& stage = begin(30);
  display_.skips = 1;
  stage.showWaiting(paper());
  stepFor(stage, 40ms);
  EXPECT_TRUE(display_.shown.empty());
  EXPECT_FALSE(stage.status().isWaitingShown);
  EXPECT_TRUE(stage.isIdle());
}

TEST_F(WaitingPictureStage, IsLeftAloneByTheStreamThatItWasOpenedFor) {
  OutputStage& stage = begin(30);
  stage.reconfigure({.size = kSize, .framePeriod = {}});
  stepFor(stage, 40ms);
  EXPECT_TRUE(stage.isReconfigured());
  EXPECT_EQ(display_.reconfigured, 0);
  EXPECT_EQ(stage.status().starts, 1u);
}

TEST_F(WaitingPictureStage, KeepsTheLastFrameThatWasShownWhole) {
  OutputStage& stage = begin(60);
  stage.showWaiting(paper());
  stepFor(stage, 40ms);
  EXPECT_FALSE(stage.lastFrame().has_value());
  live_.start();
  live_.runFor(300ms);
  EXPECT_FALSE(stage.lastFrame().has_value()) << "what fades in still bears the text";
  live_.drain();
  ASSERT_TRUE(stage.lastFrame().has_value());
  EXPECT_EQ(stage.lastFrame()->size(), kSize);
}

/// Over the first pixel, opaque.
std::shared_ptr<const Caption> spot(std::uint8_t level) {
  auto caption = std::make_shared<Caption>();
  caption->image = hal::Image(paper({2, 1}, level)->view());
  caption->image.plane(0)[3] = 255;
  caption->image.plane(0)[7] = 255;
  caption->frame = {.pixelFormat = hal::PixelFormat::kRgba8, .size = kSize, .encoding = {}};
  return caption;
}

TEST_F(WaitingPictureStage, ACaptionLiesOverFramesAndIsNoPartOfThem) {
  OutputStage& stage = begin(60);
  live_.start();
  live_.runFor(500ms);
  EXPECT_EQ(level(display_.shown.back()), 0) << "a control";
  stage.setCaption(spot(255), 1.0);
  live_.runFor(500ms);
  EXPECT_EQ(level(display_.shown.back()), 255);
  ASSERT_TRUE(stage.lastFrame().has_value());
  EXPECT_EQ(stage.lastFrame()->view().row(0, 0)[0], 0);
  stage.setCaption(nullptr, 0.0);
  live_.runFor(500ms);
  EXPECT_EQ(level(display_.shown.back()), 0);
}

TEST_F(WaitingPictureStage, ACaptionComesAndGoesOnAPictureThatStays) {
  OutputStage& stage = begin(30);
  stage.showWaiting(paper());
  stepFor(stage, 40ms);
  ASSERT_EQ(level(display_.shown.back()), kPaper);
  stage.setCaption(spot(10), 1.0);
  stepFor(stage, 40ms);
  EXPECT_EQ(level(display_.shown.back()), 10);
  stage.setCaption(spot(10), 1.0);
  stage.setCaption(nullptr, 0.0);
  stepFor(stage, 40ms);
  EXPECT_EQ(level(display_.shown.back()), kPaper);
  EXPECT_TRUE(stage.status().isWaitingShown);
}

}  // namespace
}  // namespace pleinair::runtime
