// What a display shows from the program's start on: a fake card, whose refreshes follow a stepped
// clock, behind the display output and an output stage.
#include "firmware_app/live/screens/screens.h"

#include <chrono>
#include <fstream>
#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "hal/outputs/display/display_output.h"
#include "pipeline/runtime/live_pipeline.h"
#include "tests/support/fake_card.h"
#include "tests/support/live_simulation.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;

constexpr hal::FrameSize kSize{64, 48};

class ScreensTest : public testing::Test {
 protected:
  ScreensTest()
      : selector_(support::selectorOf(
            [this](hal::Clock& clock) -> std::unique_ptr<hal::Camera> {
              ++cameras_;
              return std::make_unique<support::PacedCamera>(
                  support::PacedCameraOptions{.size = kSize}, clock);
            },
            clock_)),
        supervisor_(selector_, clock_),
        pipeline_(supervisor_, clock_) {}

  runtime::OutputStage& plug(support::FakeCardSpec spec = {}, int quarterTurns = 0) {
    spec_ = &cards_.add(std::move(spec));
    hal::DisplaySettings settings;
    settings.placement.quarterTurns = quarterTurns;
    const hal::OutputRequest request{.size = kSize, .framePeriod = {}};
    auto output = *hal::openDisplay("display", settings, cards_, clock_);
    const auto format = output->start(request);
    EXPECT_TRUE(format.has_value());
    runtime::OutputStageOptions options{.name = "display", .waiting = 16};
    options.keepsLastFrame = true;
    options.request = request;
    options.reopen = [this, settings]() -> hal::Result<std::unique_ptr<hal::Output>> {
      return *hal::openDisplay("display", settings, cards_, clock_);
    };
    runtime::OutputStage& stage =
        pipeline_.addOutput(std::move(output), *format, std::move(options));
    screens_.add(stage, true);
    return stage;
  }
  void update() {
    const auto painting = hasBegun_ ? pipeline_.paint().status() : runtime::PaintStage::Status();
    screens_.update({.camera = pipeline_.capture().status(),
                     .hasBegun = hasBegun_,
                     .hasPainter = painting.hasPainter,
                     .painted = painting.painted});
  }
  void beginToPaint() {
    while (!pipeline_.capture().status().format) pipeline_.capture().step(clock_.now());
    pipeline_.makePaintStage(
        [this]() -> std::unique_ptr<runtime::FramePainter> {
          if (isGpuGone_)
            throw hal::Failure({.kind = hal::ErrorKind::kUnsupported, .subject = "GPU"});
          return std::make_unique<support::SimulatedPainter>(gpu_, clock_);
        },
        {.governor = {.levels = 5, .pinned = {}}, .latency = {}, .framePeriod = 33'333us});
    pipeline_.paint().start();
    pipeline_.capture().open();
    hasBegun_ = true;
  }
  void runFor(hal::Duration duration) {
    for (const auto end = clock_.now() + duration; clock_.now() < end;) {
      update();
      pipeline_.output(0).step();
      if (hasBegun_) pipeline_.paint().step();
      if (hasBegun_) {
        pipeline_.capture().step(clock_.now() + 1ms);
      } else {
        clock_.advance(1ms);
      }
    }
  }
  /// Paper is light, the simulated painter's frames are black.
  bool showsPaper() const { return (cards_.shown.back().firstPixel & 0xFFU) > 200; }

  hal::SteppedClock clock_{hal::TimePoint(100s)};
  support::FakeCards cards_{clock_};
  support::FakeCardSpec* spec_ = nullptr;
  support::SimulatedGpu gpu_;
  int cameras_ = 0;
  bool hasBegun_ = false;
  bool isGpuGone_ = false;
  hal::CameraSelector selector_;
  hal::CameraSupervisor supervisor_;
  runtime::LivePipeline pipeline_;
  support::TemporaryFolder folder_;
  Screens screens_{"v4l2", folder_.path(), clock_};
};

TEST_F(ScreensTest, ShowAPictureBeforeThereIsACameraOrAPainter) {
  plug();
  EXPECT_TRUE(cards_.shown.empty()) << "a control: black, until a picture is drawn";
  update();
  screens_.showFirst(clock_);
  ASSERT_EQ(cards_.shown.size(), 1u);
  EXPECT_TRUE(showsPaper());
  EXPECT_LT(cards_.shown.front().time - hal::TimePoint(100s), 60ms);
  EXPECT_EQ(cameras_, 0);
  EXPECT_EQ(gpu_.made, 0);
}

TEST_F(ScreensTest, DrawAPictureOnceForEachThingThatIsAwaited) {
  plug();
  runFor(3s);
  EXPECT_EQ(cards_.shown.size(), 1u) << "the camera: not again and again";
  EXPECT_EQ(cards_.modesets, 1);
}

TEST_F(ScreensTest, ShowThePictureAgainWhereThatIsAskedForAndCountWhatIsSeen) {
  screens_.renewAfter(500ms);
  runtime::OutputStage& stage = plug();
  runFor(3s);
  EXPECT_GE(cards_.shown.size(), 5u);
  EXPECT_LE(cards_.shown.size(), 7u);
  EXPECT_EQ(stage.status().waitingShown, cards_.shown.size());
  EXPECT_TRUE(showsPaper());
}

TEST_F(ScreensTest, CountNothingWhereADisplayHangs) {
  screens_.renewAfter(500ms);
  support::FakeCardSpec spec;
  spec.losesFlips = true;
  runtime::OutputStage& stage = plug(std::move(spec));
  const std::uint64_t steps = stage.status().steps;
  runFor(3s);
  EXPECT_EQ(stage.status().waitingShown, 0u);
  EXPECT_GT(stage.status().steps, steps) << "though its thread turns";
}

TEST_F(ScreensTest, GoOverToPaintingsAndBack) {
  runtime::OutputStage& stage = plug();
  update();
  screens_.showFirst(clock_);
  beginToPaint();
  runFor(2s);
  EXPECT_FALSE(showsPaper());
  EXPECT_EQ(cards_.shown.back().firstPixel, 0u) << "whole, after it has faded in";
  EXPECT_EQ(stage.status().starts, 1u);
  gpu_.isLost = isGpuGone_ = true;
  runFor(200ms);
  EXPECT_TRUE(showsPaper()) << "the GPU is lost, and the frames on their way have been shown";
  isGpuGone_ = false;
  runFor(2500ms);
  EXPECT_FALSE(showsPaper()) << "there is another painter";
  EXPECT_EQ(gpu_.made, 2);
}

TEST_F(ScreensTest, DrawAgainOnADisplayThatCameBack) {
  plug();
  update();
  screens_.showFirst(clock_);
  spec_->connectors.front().isConnected = false;
  runFor(3s);
  EXPECT_TRUE(pipeline_.output(0).status().isFailed);
  spec_->connectors.front().isConnected = true;
  cards_.shown.clear();
  runFor(6s);
  ASSERT_FALSE(cards_.shown.empty());
  EXPECT_TRUE(showsPaper());
  EXPECT_EQ(pipeline_.output(0).status().starts, 2u);
}

TEST_F(ScreensTest, ShowPaintingsAtOnceOnADisplayThatCameBackWhilePaintingWentOn) {
  plug();
  update();
  screens_.showFirst(clock_);
  beginToPaint();
  runFor(2s);
  spec_->connectors.front().isConnected = false;
  runFor(10s);
  spec_->connectors.front().isConnected = true;
  cards_.shown.clear();
  runFor(6s);
  ASSERT_FALSE(cards_.shown.empty());
  EXPECT_EQ(cards_.shown.front().firstPixel, 0u) << "not that painting is too slow";
}

TEST_F(ScreensTest, FollowTheCamerasFormatWithoutAnotherModeset) {
  runtime::OutputStage& stage = plug({.connectors = {{.modes = {{.size = {128, 48}}}}}});
  update();
  screens_.showFirst(clock_);
  stage.reconfigure({.size = {48, 48}, .framePeriod = {}});
  runFor(100ms);
  EXPECT_EQ(stage.format().frame.size, (hal::FrameSize{48, 48}));
  EXPECT_EQ(cards_.modesets, 1);
  EXPECT_EQ(cards_.shown.size(), 2u) << "drawn again, at its new size";
}

TEST_F(ScreensTest, GiveUpWaitingForADisplayThatShowsNothing) {
  support::FakeCardSpec spec;
  spec.losesFlips = true;
  plug(std::move(spec));
  update();
  const hal::TimePoint began = clock_.now();
  screens_.showFirst(clock_);
  EXPECT_LE(clock_.now() - began, 1100ms);
}

TEST_F(ScreensTest, KeepTheLastPaintingForTheNextRun) {
  plug();
  update();
  screens_.showFirst(clock_);
  screens_.finish();
  EXPECT_EQ(folder_.entryCount(), 0u) << "a control: no painting was shown";
  beginToPaint();
  runFor(2s);
  EXPECT_EQ(folder_.entryCount(), 0u) << "not within the first minute";
  screens_.finish();
  EXPECT_FALSE(screens_.takeFailure().has_value());
  EXPECT_EQ(folder_.entryCount(), 1u);
}

TEST_F(ScreensTest, KeepNoPaintingTwice) {
  plug();
  update();
  screens_.showFirst(clock_);
  beginToPaint();
  runFor(1s);
  screens_.finish();
  const std::filesystem::path kept = folder_.path() / "last-painting.png";
  ASSERT_TRUE(std::filesystem::remove(kept));
  clock_.advance(2min);
  screens_.finish();
  EXPECT_FALSE(std::filesystem::exists(kept)) << "nothing was shown since";
  runFor(1s);
  screens_.finish();
  EXPECT_TRUE(std::filesystem::exists(kept));
}

TEST_F(ScreensTest, IgnoreAKeptPaintingThatIsBroken) {
  std::ofstream(folder_.path() / "last-painting.png") << "no picture";
  plug();
  const auto failure = screens_.takeFailure();
  ASSERT_TRUE(failure.has_value());
  EXPECT_NE(failure->message().find("last-painting.png"), std::string::npos);
  update();
  screens_.showFirst(clock_);
  EXPECT_TRUE(showsPaper());
}

TEST_F(ScreensTest, TurnThePictureAsTheDisplayHangs) {
  runtime::OutputStage& stage = plug({}, 1);
  update();
  screens_.showFirst(clock_);
  ASSERT_EQ(cards_.shown.size(), 1u);
  EXPECT_EQ(stage.format().quarterTurns, 1);
  EXPECT_EQ(stage.format().frame.size, (hal::FrameSize{36, 48}));
}

}  // namespace
}  // namespace pleinair::app
