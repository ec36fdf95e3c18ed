// A display that is switched off while nobody is there, from the camera's frames to the card, under
// a stepped clock.
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "hal/outputs/display/display_output.h"
#include "pipeline/runtime/live_pipeline.h"
#include "tests/support/fake_card.h"
#include "tests/support/live_simulation.h"

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;

/// The display goes off 10 s after the last movement. The camera is noisy, and somebody walks
/// through its picture while `isSomebodyThere_`.
class BlankingPipeline : public testing::Test {
 protected:
  static constexpr hal::FrameSize kSize{160, 120};

  BlankingPipeline()
      : card_(cards_.add({})),
        selector_(support::selectorOf(
            [this](hal::Clock& clock) {
              support::PacedCameraOptions options;
              options.size = kSize;
              options.draw = [this](std::uint64_t sequence, hal::Image& image) {
                draw(sequence, image);
              };
              return std::make_unique<support::PacedCamera>(options, clock);
            },
            live_.clock)) {}

  void draw(std::uint64_t sequence, hal::Image& image) {
    for (std::uint8_t& each : image.plane(0)) {
      each = static_cast<std::uint8_t>(100 + random_() % 21);
    }
    if (!isSomebodyThere_) return;
    const int left = static_cast<int>(sequence * 3 % 130);
    for (int y = 40; y < 100; ++y) {
      for (int x = left; x < left + 20; ++x) image.row(0, y)[static_cast<std::size_t>(x)] += 50;
    }
  }

  void begin() {
    live_.begin(selector_);
    auto display = *hal::openDisplay(
        "display", {.blanking = {.times = {}, .after = hal::Duration(10s)}}, cards_, live_.clock);
    stage_ = &live_.addOutput(std::move(display), {.name = "display", .waiting = 16});
    live_.start();
  }
  /// As the main thread does. Returns when the display first was on, or off.
  std::optional<hal::Duration> runUntil(bool isOn, hal::Duration most) {
    const hal::TimePoint began = live_.clock.now();
    while (live_.clock.now() < began + most) {
      live_.runFor(10ms);
      const auto moved = live_.chain->capture().movedAt();
      if (std::exchange(movedAt_, moved) != moved) stage_->noteActivity();
      if (card_.isOn == isOn) return live_.clock.now() - began;
    }
    return std::nullopt;
  }
  std::uint64_t of(Outcome outcome) const {
    return stage_->status().ended.at(static_cast<std::size_t>(outcome));
  }

  support::LiveSimulation live_;
  support::FakeCards cards_{live_.clock};
  support::FakeCardSpec& card_;
  bool isSomebodyThere_ = false;
  std::minstd_rand random_{3};
  hal::CameraSelector selector_;
  OutputStage* stage_ = nullptr;
  std::optional<hal::TimePoint> movedAt_;
};

TEST_F(BlankingPipeline, GoesOffAndOnWithinASecondOfAMovementAndStaysOn) {
  begin();
  const auto off = runUntil(false, 20s);
  ASSERT_TRUE(off.has_value());
  EXPECT_GE(*off, 9s);
  EXPECT_EQ(stage_->status().suspension->cause, hal::Suspension::Cause::kBlank);
  EXPECT_TRUE(live_.chain->status().outputs.back().suspension.has_value());

  // The control: noise alone.
  EXPECT_EQ(runUntil(true, 60s), std::nullopt);
  EXPECT_EQ(card_.isOn, false);

  for (int i = 0; i < 5; ++i) {
    const std::uint64_t shown = of(Outcome::kShown);
    isSomebodyThere_ = true;
    const auto on = runUntil(true, 5s);
    ASSERT_TRUE(on.has_value());
    EXPECT_LE(*on, 1s);
    // No flicker: one modeset, and then it stays on.
    const int modesets = cards_.modesets;
    EXPECT_EQ(runUntil(false, 30s), std::nullopt);
    EXPECT_EQ(cards_.modesets, modesets);
    EXPECT_GT(of(Outcome::kShown), shown + 800);
    isSomebodyThere_ = false;
    const auto again = runUntil(false, 20s);
    ASSERT_TRUE(again.has_value());
    EXPECT_GE(*again, 9s);
  }
  EXPECT_EQ(cards_.switchedOff, 6);
}

TEST_F(BlankingPipeline, PaintsOnlyNowAndThenWhileNobodyLooks) {
  begin();
  live_.chain->paint().remove(live_.chain->output(0));  // the one that has no display
  ASSERT_TRUE(runUntil(false, 20s).has_value());
  live_.runFor(2s);
  const std::uint64_t painted = live_.chain->paint().status().painted;
  const std::uint64_t shown = of(Outcome::kShown);
  live_.runFor(10s);
  EXPECT_GE(live_.chain->paint().status().painted, painted + 9);
  EXPECT_LE(live_.chain->paint().status().painted, painted + 11);
  EXPECT_GT(live_.chain->ledger().counts().of(Outcome::kBlanked), 280u);
  isSomebodyThere_ = true;
  const auto on = runUntil(true, 5s);
  ASSERT_TRUE(on.has_value());
  EXPECT_LE(*on, 1s);
  live_.runFor(2s);
  EXPECT_GT(of(Outcome::kShown), shown + 50);
  EXPECT_TRUE(live_.chain->ledger().counts().addsUp());
}

TEST_F(BlankingPipeline, FramesMeanwhileAreTold) {
  begin();
  ASSERT_TRUE(runUntil(false, 20s).has_value());
  const LedgerCounts before = live_.chain->ledger().counts();
  live_.runFor(10s);
  const LedgerCounts counts = live_.chain->ledger().counts();
  EXPECT_TRUE(counts.addsUp());
  EXPECT_EQ(counts.of(Outcome::kShown) - before.of(Outcome::kShown),
            counts.captured - before.captured + before.inFlight - counts.inFlight)
      << "on the other output";
  EXPECT_GE(of(Outcome::kBlanked), 290u);
  EXPECT_EQ(of(Outcome::kOutputFailed) + of(Outcome::kNoSurface), 0u);
  EXPECT_TRUE(stage_->status().addsUp());
  EXPECT_EQ(stage_->status().failures, 0u);
}

TEST_F(BlankingPipeline, AConsoleInFrontIsToldToo) {
  begin();
  live_.runFor(2s);
  hal::leaveConsole();
  live_.runFor(2s);
  EXPECT_TRUE(card_.showsConsole);
  EXPECT_GE(of(Outcome::kSuspended), 55u);
  EXPECT_EQ(of(Outcome::kOutputFailed), 0u);
  hal::enterConsole();
  const std::uint64_t shown = of(Outcome::kShown);
  live_.runFor(2s);
  EXPECT_FALSE(card_.showsConsole);
  EXPECT_GE(of(Outcome::kShown), shown + 50);
  EXPECT_EQ(stage_->status().failures, 0u);
}

}  // namespace
}  // namespace pleinair::runtime
