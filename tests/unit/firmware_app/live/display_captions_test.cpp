#include "firmware_app/live/interaction/display_captions.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "pipeline/present/waiting_picture.h"
#include "pipeline/runtime/live_pipeline.h"
#include "tests/support/fake_display_output.h"
#include "tests/support/live_simulation.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;

hal::OutputFormat formatOf(hal::FrameSize size, int quarterTurns) {
  return {.frame = {.pixelFormat = hal::PixelFormat::kRgba8, .size = size, .encoding = {}},
          .refresh = std::nullopt,
          .quarterTurns = quarterTurns};
}

/// A black frame with its caption.
hal::Image captioned(const hal::OutputFormat& format) {
  hal::Image frame(format.frame);
  for (std::uint8_t& each : frame.plane(0)) each = 90;
  const auto caption = captionFor("help\tfor people", format);
  EXPECT_NE(caption, nullptr);
  runtime::CaptionOverlay().draw(frame, *caption, 1.0);
  return frame;
}

TEST(CaptionFor, StandsUprightWhicheverWayTheDisplayHangs) {
  // Seen by people, the picture is 320 by 240 px each time.
  const hal::Image upright = captioned(formatOf({320, 240}, 0));
  for (int turns = 1; turns < 4; ++turns) {
    const hal::FrameSize size =
        turns % 2 == 0 ? hal::FrameSize{320, 240} : hal::FrameSize{240, 320};
    const hal::Image turned = captioned(formatOf(size, turns));
    const hal::Image seen = present::turned(turned, 4 - turns);
    ASSERT_EQ(seen.size(), upright.size());
    EXPECT_TRUE(std::ranges::equal(seen.view().planes[0].bytes, upright.view().planes[0].bytes))
        << turns;
  }
}

TEST(CaptionFor, IsNothingOnASmallPicture) {
  EXPECT_EQ(captionFor("text", formatOf({16, 12}, 0)), nullptr);
}

/// A display that waits for a camera, with a caption over its waiting picture.
class DisplayCaptionsTest : public testing::Test {
 protected:
  static constexpr hal::FrameSize kSize{160, 120};

  DisplayCaptionsTest() {
    auto output = std::make_unique<support::FakeDisplayOutput>(display_, clock_);
    const auto format = output->start({.size = kSize, .framePeriod = {}});
    stage_ = std::make_unique<runtime::OutputStage>(std::move(output), *format,
                                                    runtime::OutputStageOptions{.name = "display"},
                                                    clock_, ledger_);
    stage_->showWaiting(std::make_shared<hal::Image>(format->frame));
    run(50ms);
  }
  std::uint64_t brightness() const { return display_.shown.back().brightness; }
  void run(hal::Duration duration) {
    for (const auto end = clock_.now() + duration; clock_.now() < end;) {
      captions_.update({stage_.get()}, caption_);
      stage_->step();
      clock_.advance(10ms);
    }
  }

  hal::SteppedClock clock_{hal::TimePoint(100s)};
  support::FakeDisplay display_;
  runtime::FrameLedger ledger_;
  std::unique_ptr<runtime::OutputStage> stage_;
  config::ParameterValues nothing_{
      std::make_shared<const config::ParameterList>(std::vector<config::ParameterDescriptor>{})};
  LiveTuning tuning_{{{.name = "brush",
                       .start = {.style = nothing_, .view = {}},
                       .views = {{"cells", ""}},
                       .looks = {}}}};
  LiveCaption caption_{tuning_, clock_};
  DisplayCaptions captions_;
};

TEST_F(DisplayCaptionsTest, AnswersAKeyAndGoesAgain) {
  ASSERT_EQ(brightness(), 0u) << "a control: the picture is black";
  ASSERT_EQ(display_.shown.size(), 1u);
  tuning_.press({.name = "v"});
  caption_.keyPressed();
  run(100ms);
  const std::uint64_t whole = brightness();
  EXPECT_GT(whole, 5000u) << "letters are seen";
  run(3200ms);
  EXPECT_LT(brightness(), whole) << "they fade";
  EXPECT_GT(brightness(), 0u);
  run(500ms);
  EXPECT_EQ(brightness(), 0u);
  const std::size_t shown = display_.shown.size();
  run(2s);
  EXPECT_EQ(display_.shown.size(), shown) << "and leave the display alone";
}

TEST_F(DisplayCaptionsTest, KeepsThePinnedStepOfAProcedure) {
  caption_.pin("1/8  Screw it down");
  run(10s);
  EXPECT_GT(brightness(), 5000u);
  EXPECT_LE(display_.shown.size(), 3u) << "it is drawn once";
  caption_.pin("");
  run(100ms);
  EXPECT_EQ(brightness(), 0u);
}

TEST_F(DisplayCaptionsTest, KeepsTheHelpUntilItIsPutAway) {
  tuning_.press({.name = "h"});
  caption_.keyPressed();
  run(20s);
  const std::uint64_t help = brightness();
  EXPECT_GT(help, 5000u);
  tuning_.press({.name = "h"});
  caption_.keyPressed();
  run(100ms);
  EXPECT_LT(brightness(), help / 2);
}

}  // namespace
}  // namespace pleinair::app
