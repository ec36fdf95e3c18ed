// Outputs that lend surfaces, and outputs that come and go, in a live pipeline under a stepped
// clock: a camera of 30 frames a second, a painter that takes 20 ms, simulated displays.
#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/runtime/live_pipeline.h"
#include "tests/support/fake_display_output.h"
#include "tests/support/live_simulation.h"

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;
using support::FakeDisplay;
using support::FakeDisplayOutput;

class SurfaceOutputTest : public testing::Test {
 protected:
  SurfaceOutputTest()
      : selector_(support::selectorOf(
            [this](hal::Clock& clock) {
              began_ = clock.now();
              return std::make_unique<support::PacedCamera>(camera_, clock);
            },
            live_.clock)) {}

  /// Begins with the simulation's own output in memory, of which these tests check the sums only.
  void begin(std::uint64_t frames) {
    camera_.frames = frames;
    live_.begin(selector_);
  }
  OutputStage& add(FakeDisplay& display, OutputStageOptions options) {
    return live_.addOutput(std::make_unique<FakeDisplayOutput>(display, live_.clock),
                           std::move(options));
  }
  static std::uint64_t of(const OutputStage& stage, Outcome outcome) {
    return stage.status().ended.at(static_cast<std::size_t>(outcome));
  }
  void expectSumsToAgree() const {
    EXPECT_TRUE(live_.chain->ledger().counts().addsUp());
    for (const auto& output : live_.chain->status().outputs) EXPECT_TRUE(output.addsUp());
  }

  support::LiveSimulation live_;
  support::PacedCameraOptions camera_;
  hal::TimePoint began_;
  hal::CameraSelector selector_;
};

TEST_F(SurfaceOutputTest, ShowsEveryFrameAtItsRefreshOnTheDisplaysOwnGrid) {
  FakeDisplay at60{.period = 16'683'350ns, .phase = hal::TimePoint(7ms)};  // 59.94 Hz
  FakeDisplay at50{.period = 20ms, .phase = hal::TimePoint(3ms)};
  begin(600);
  OutputStage& stage60 = add(at60, {.name = "60 Hz", .waiting = 16});
  OutputStage& stage50 = add(at50, {.name = "50 Hz", .waiting = 16});
  live_.start();
  live_.drain();
  for (const auto& [display, stage] : {std::pair{&at60, &stage60}, {&at50, &stage50}}) {
    EXPECT_EQ(of(*stage, Outcome::kShown), 600u) << stage->name();
    ASSERT_EQ(display->shown.size(), 600u) << stage->name();
    for (std::size_t i = 0; i < display->shown.size(); ++i) {
      const hal::TimePoint captured = began_ + static_cast<int>(i) * camera_.period;
      const hal::Refresh refresh{.period = display->period, .phase = display->phase};
      ASSERT_EQ(display->shown[i].time, dueTime(captured, 120ms, refresh)) << stage->name();
    }
  }
  // An output in memory beside them, such as a loopback, keeps its own due times.
  ASSERT_EQ(live_.notes.size(), 600u);
  for (const auto& note : live_.notes) ASSERT_EQ(note.presented, began_ + note.time + 120ms);
  EXPECT_EQ(live_.chain->ledger().counts().of(Outcome::kShown), 600u);
  expectSumsToAgree();
}

TEST_F(SurfaceOutputTest, ADisplayThatIsStuckDelaysNoLoopbackAndNoOtherDisplay) {
  FakeDisplay stuck{.phase = hal::TimePoint(7ms), .holds = 1'000'000};
  FakeDisplay runs{.period = 20ms, .phase = hal::TimePoint(3ms)};
  begin(300);
  OutputStage& first = add(stuck, {.name = "stuck", .waiting = 16});
  OutputStage& second = add(runs, {.name = "runs", .waiting = 16});
  live_.start();
  live_.runFor(11s);
  EXPECT_LE(stuck.shown.size(), 1u);
  EXPECT_GT(of(first, Outcome::kNoSurface), 200u);
  EXPECT_EQ(of(second, Outcome::kShown), 300u);
  ASSERT_EQ(live_.notes.size(), 300u);
  for (const auto& note : live_.notes) ASSERT_EQ(note.presented, began_ + note.time + 120ms);
  expectSumsToAgree();
}

TEST_F(SurfaceOutputTest, LearnsThePhaseFromTheFirstFlip) {
  FakeDisplay display{.period = 20ms, .phase = hal::TimePoint(3ms), .tellsPhase = false};
  begin(100);
  OutputStage& stage = add(display, {.name = "display", .waiting = 16});
  live_.start();
  live_.drain();
  EXPECT_EQ(of(stage, Outcome::kShown), 100u);
  ASSERT_EQ(display.shown.size(), 100u);
  // The due times of frames painted before the first flip do not use its phase.
  for (std::size_t i = 6; i < display.shown.size(); ++i) {
    const hal::TimePoint captured = began_ + static_cast<int>(i) * camera_.period;
    const hal::Refresh refresh{.period = display.period, .phase = display.phase};
    ASSERT_EQ(display.shown[i].time, dueTime(captured, 120ms, refresh)) << i;
  }
}

TEST_F(SurfaceOutputTest, CountsFramesForWhichNoSurfaceIsFree) {
  FakeDisplay display{.surfaces = 1};  // which stays on the screen, as no other replaces it
  begin(90);
  OutputStage& stage = add(display, {.name = "display", .waiting = 16});
  live_.start();
  live_.drain();
  EXPECT_EQ(of(stage, Outcome::kShown), 1u);
  EXPECT_EQ(of(stage, Outcome::kNoSurface), 89u);
  expectSumsToAgree();
}

TEST_F(SurfaceOutputTest, CountsFramesByWhatTheDisplayDidWithThem) {
  FakeDisplay display;
  begin(300);
  OutputStage& stage = add(display, {.name = "display", .waiting = 16});
  live_.start();
  live_.runFor(2s);
  display.skips = 5;
  live_.runFor(2s);
  display.holds = 1;
  live_.drain();
  EXPECT_EQ(of(stage, Outcome::kOutputBusy), 5u) << "skipped flips";
  EXPECT_EQ(of(stage, Outcome::kShownOffSchedule), 1u) << "a flip that came one refresh late";
  EXPECT_EQ(of(stage, Outcome::kShown), 294u);
  EXPECT_EQ(display.shown.size(), 295u);
  expectSumsToAgree();
}

TEST_F(SurfaceOutputTest, JudgesByTheDisplaysOwnCount) {
  FakeDisplay display;
  begin(300);
  OutputStage& stage = add(display, {.name = "display", .waiting = 16});
  live_.start();
  live_.runFor(2s);
  display.sequenceJump = 1;  // its times go on as they did
  live_.drain();
  EXPECT_EQ(of(stage, Outcome::kShownOffSchedule), 1u) << "the one that was on its way then";
  EXPECT_EQ(of(stage, Outcome::kShown), 299u);
  expectSumsToAgree();
}

TEST_F(SurfaceOutputTest, LogsWhatBecameOfEachFrame) {
  FakeDisplay display;
  FrameLog log;
  begin(90);
  add(display, {.name = "display", .waiting = 16, .log = &log, .logNumber = 1});
  live_.start();
  live_.runFor(1s);
  display.holds = 1;
  live_.runFor(1s);
  display.skips = 1;
  live_.drain();
  std::vector<FrameRecord> records;
  EXPECT_EQ(log.take(records), 0u);
  ASSERT_EQ(records.size(), 90u);
  std::size_t late = 0;
  std::size_t skipped = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const FrameRecord& each = records[i];
    EXPECT_EQ(each.output, 1u);
    EXPECT_EQ(each.sequence, i);
    EXPECT_EQ(each.captured, began_ + static_cast<int>(i) * camera_.period);
    EXPECT_GE(each.due, each.captured + 120ms);
    EXPECT_GT(each.ready, each.captured);
    if (each.outcome == Outcome::kOutputBusy) {
      ++skipped;
      EXPECT_FALSE(each.shown || each.refresh);
      continue;
    }
    const std::uint64_t off = each.outcome == Outcome::kShownOffSchedule ? 1 : 0;
    late += off;
    ASSERT_TRUE(each.shown);
    EXPECT_EQ(*each.shown, each.due + static_cast<int>(off) * display.period);
    // The first ones were due before a flip had told the display's count.
    if (each.dueRefresh) {
      EXPECT_EQ(*each.refresh, *each.dueRefresh + off);
    }
    EXPECT_EQ(each.dueRefresh.has_value(), i > 0) << i;
  }
  EXPECT_EQ(late, 1u);
  EXPECT_EQ(skipped, 1u);
}

TEST(Refresh, IsTheNearestToATime) {
  const hal::Refresh refresh{.period = 10ms, .phase = hal::TimePoint(100ms), .sequence = 50};
  EXPECT_EQ(hal::sequenceAt(hal::TimePoint(100ms), refresh), 50u);
  EXPECT_EQ(hal::sequenceAt(hal::TimePoint(104ms), refresh), 50u);
  EXPECT_EQ(hal::sequenceAt(hal::TimePoint(106ms), refresh), 51u);
  EXPECT_EQ(hal::sequenceAt(hal::TimePoint(96ms), refresh), 50u);
  EXPECT_EQ(hal::sequenceAt(hal::TimePoint(94ms), refresh), 49u);
  EXPECT_EQ(hal::sequenceAt(hal::TimePoint(1100ms), refresh), 150u);
  EXPECT_EQ(hal::sequenceAt(hal::TimePoint(0ms), hal::Refresh{.period = 10ms, .phase = {}}),
            std::nullopt);
}

TEST_F(SurfaceOutputTest, OpensADisplayAnewThatWasUnplugged) {
  FakeDisplay display;
  begin(900);
  OutputStageOptions options{.name = "display", .waiting = 16};
  options.reopen = [&]() -> hal::Result<std::unique_ptr<hal::Output>> {
    return std::make_unique<FakeDisplayOutput>(display, live_.clock);
  };
  options.request = {.size = {8, 6}};
  OutputStage& stage = add(display, std::move(options));
  live_.start();
  live_.runFor(5s);
  display.isLost = true;
  live_.runFor(5s);
  EXPECT_TRUE(stage.status().isFailed);
  EXPECT_FALSE(stage.status().isFinal);
  display.isLost = false;
  live_.drain();
  EXPECT_FALSE(stage.status().isFailed);
  EXPECT_EQ(display.opened, 2);
  EXPECT_EQ(of(stage, Outcome::kShown), display.shown.size());
  EXPECT_EQ(of(stage, Outcome::kShown) + of(stage, Outcome::kOutputFailed), 900u);
  EXPECT_GT(of(stage, Outcome::kOutputFailed), 140u);
  EXPECT_EQ(live_.chain->ledger().counts().of(Outcome::kShown), 900u) << "the other output goes on";
  expectSumsToAgree();
}

TEST_F(SurfaceOutputTest, HasASurfaceFilledInAnotherWay) {
  FakeDisplay display;
  std::uint8_t painted = 0;
  OutputStageOptions options{.name = "display", .waiting = 16};
  options.fill = [&](const OutputFrame&, hal::SurfaceOutput& output,
                     const hal::Surface& surface) -> hal::Result<hal::Fence> {
    const auto mapping = output.map(surface);
    ++painted;
    for (std::uint8_t& byte : mapping->plane(0)) byte = painted;
    return hal::Fence();
  };
  begin(50);
  add(display, std::move(options));
  live_.start();
  live_.drain();
  ASSERT_EQ(display.shown.size(), 50u);
  EXPECT_EQ(display.shown.front().firstPixel, 0x01010101u);
  EXPECT_EQ(display.shown.back().firstPixel, 0x32323232u);
}

TEST_F(SurfaceOutputTest, BeginsEarlierWhereFillingTakesLong) {
  FakeDisplay display;
  OutputStageOptions options{.name = "display", .waiting = 16};
  options.fill = [&](const OutputFrame&, hal::SurfaceOutput&, const hal::Surface&) {
    live_.clock.sleepUntil(live_.clock.now() + 18ms);  // more than a refresh
    return hal::Result<hal::Fence>(hal::Fence());
  };
  begin(100);
  const OutputStage& stage = add(display, std::move(options));
  live_.start();
  live_.drain();
  EXPECT_EQ(of(stage, Outcome::kShownOffSchedule), 1u) << "the first, of which that is not known";
  EXPECT_EQ(of(stage, Outcome::kShown), 99u);
  expectSumsToAgree();
}

TEST_F(SurfaceOutputTest, ReleasesASurfaceThatCannotBeFilled) {
  FakeDisplay display;
  OutputStageOptions options{.name = "display", .waiting = 16};
  options.fill = [](const OutputFrame&, hal::SurfaceOutput&,
                    const hal::Surface&) -> hal::Result<hal::Fence> {
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kUnsupported,
                                     .subject = "GPU",
                                     .problem = "cannot draw there",
                                     .remedy = {}});
  };
  begin(50);
  const OutputStage& stage = add(display, std::move(options));
  live_.start();
  live_.drain();
  EXPECT_EQ(display.lent, 0);
  EXPECT_EQ(stage.status().failures, 1u);
  EXPECT_EQ(of(stage, Outcome::kOutputFailed), 50u);
  expectSumsToAgree();
}

TEST_F(SurfaceOutputTest, StepsTheLatencyByTheLongestRefresh) {
  FakeDisplay at50{.period = 20ms};
  live_.gpu.cost = [](auto, auto) { return 130ms; };  // too slow for the latency at any quality
  live_.painting.governor = {.levels = 1, .pinned = 0};
  begin(60);
  add(at50, {.name = "50 Hz", .waiting = 16});
  live_.start();
  live_.drain();
  const PaintStage::Status painting = live_.chain->status().painting;
  EXPECT_GT(painting.latency, 120ms);
  EXPECT_EQ((painting.latency - 120ms) % 20ms, 0ms);
}

TEST_F(SurfaceOutputTest, ComesAndGoesWhilePaintingGoesOn) {
  FakeDisplay display;
  begin(900);
  live_.start();
  live_.runFor(5s);
  OutputStage& stage = add(display, {.name = "display", .waiting = 16});
  live_.runFor(5s);
  EXPECT_GT(display.shown.size(), 140u);
  EXPECT_EQ(of(stage, Outcome::kShown), display.shown.size());
  EXPECT_EQ(live_.chain->status().outputs.size(), 2u);

  live_.chain->removeOutput(stage);
  EXPECT_EQ(live_.chain->takeRemoved(stage), nullptr) << "the painter has not let go of it yet";
  live_.runFor(1s);
  const std::unique_ptr<OutputStage> removed = live_.chain->takeRemoved(stage);
  ASSERT_EQ(removed.get(), &stage);
  EXPECT_TRUE(removed->finish());
  EXPECT_TRUE(removed->status().addsUp());
  EXPECT_EQ(removed->status().waiting, 0u);
  EXPECT_EQ(live_.chain->status().outputs.size(), 1u);
  EXPECT_LT(display.shown.size(), 165u);

  live_.drain();
  EXPECT_EQ(live_.chain->ledger().counts().of(Outcome::kShown), 900u) << "the other output has all";
  expectSumsToAgree();
}

TEST_F(SurfaceOutputTest, EndsFramesWhileThereIsNoOutput) {
  begin(300);
  live_.start();
  live_.runFor(3s);
  OutputStage& only = live_.chain->output(0);
  live_.chain->removeOutput(only);
  live_.runFor(2s);
  const std::unique_ptr<OutputStage> removed = live_.chain->takeRemoved(only);
  ASSERT_NE(removed, nullptr);
  EXPECT_TRUE(removed->finish());
  live_.runFor(1s);
  FakeDisplay display;
  add(display, {.name = "display", .waiting = 16});
  live_.drain();
  const LedgerCounts counts = live_.chain->ledger().counts();
  EXPECT_TRUE(counts.addsUp());
  EXPECT_EQ(counts.captured, 300u);
  EXPECT_GT(counts.of(Outcome::kOutputFailed), 80u);
  EXPECT_GT(display.shown.size(), 100u);
}

TEST_F(SurfaceOutputTest, OutlivesAGpuThatIsLostWhileOutputsComeAndGo) {
  live_.gpu.isLostAt = [](std::uint64_t sequence) { return sequence % 100 == 99; };
  begin(900);
  live_.start();
  std::vector<std::unique_ptr<FakeDisplay>> displays;
  std::vector<OutputStage*> stages;
  for (int i = 0; i < 20; ++i) {
    displays.push_back(std::make_unique<FakeDisplay>());
    stages.push_back(&add(*displays.back(), {.name = "display", .waiting = 16}));
    live_.runFor(1s);
    live_.chain->removeOutput(*stages.back());
    live_.runFor(100ms);
    const auto removed = live_.chain->takeRemoved(*stages.back());
    ASSERT_NE(removed, nullptr);
    EXPECT_TRUE(removed->finish());
    ASSERT_TRUE(live_.chain->ledger().counts().addsUp());
  }
  live_.drain();
  EXPECT_EQ(live_.chain->outputCount(), 1u);
  EXPECT_EQ(live_.chain->ledger().counts().inFlight, 0u);
  EXPECT_GT(live_.gpu.made, 5);
  for (const auto& display : displays) EXPECT_GT(display->shown.size(), 10u);
}

}  // namespace
}  // namespace pleinair::runtime
