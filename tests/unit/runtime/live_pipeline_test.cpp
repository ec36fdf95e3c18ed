// The live pipeline under a stepped clock: every case of the fixed latency
// (docs/decisions/0009-fixed-latency.md), and failures of cameras and of the GPU.
#include "pipeline/runtime/live_pipeline.h"

#include <array>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/live_simulation.h"
#include "tests/support/scripted_camera.h"

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;
using support::CapturingOutput;
using support::PacedCamera;
using support::PacedCameraOptions;

class LivePipelineTest : public testing::Test {
 protected:
  /// Begins with a paced camera; painting starts at once.
  void begin(PacedCameraOptions options = {}) {
    // NOLINTNEXTLINE(modernize-make-unique): it can be neither copied nor moved
    selector_.reset(new hal::CameraSelector(support::selectorOf(
        [options](hal::Clock& clock) { return std::make_unique<PacedCamera>(options, clock); },
        live_.clock)));
    live_.begin(*selector_, waiting_, refresh_);
    began_ = live_.clock.now();
    live_.start();
  }

  LedgerCounts counts() const { return live_.chain->ledger().counts(); }
  RuntimeStatus status() const { return live_.chain->status(); }

  void expectSumsToAgree() const {
    EXPECT_TRUE(counts().addsUp());
    for (const auto& output : status().outputs) EXPECT_TRUE(output.addsUp()) << output.name;
  }
  /// The longest time between two images at the output.
  hal::Duration maxGap() const {
    hal::Duration longest{0};
    for (std::size_t i = 1; i < live_.notes.size(); ++i) {
      longest = std::max(longest, live_.notes[i].presented - live_.notes[i - 1].presented);
    }
    return longest;
  }
  /// The time from capture to being shown for each image from `first` on.
  std::vector<hal::Duration> latencies(std::size_t first = 0) const {
    std::vector<hal::Duration> found;
    for (std::size_t i = first; i < live_.notes.size(); ++i) {
      found.push_back(live_.notes[i].presented - (began_ + live_.notes[i].time));
    }
    return found;
  }

  support::LiveSimulation live_;
  std::unique_ptr<hal::CameraSelector> selector_;
  hal::TimePoint began_;
  std::size_t waiting_ = 16;
  std::optional<hal::Refresh> refresh_;
};

TEST_F(LivePipelineTest, PresentsEveryFrameThatIsReadyExactlyAtItsDueTime) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> delay(0, 15'000);
  std::uniform_int_distribution<int> cost(5'000, 30'000);
  live_.gpu.cost = [&](auto, auto) { return std::chrono::microseconds(cost(random)); };
  begin({.delay = [&](auto) { return std::chrono::microseconds(delay(random)); }, .frames = 2'000});
  live_.drain();
  EXPECT_EQ(counts().captured, 2'000u);
  EXPECT_EQ(counts().of(Outcome::kShown), 2'000u);
  for (const hal::Duration latency : latencies()) ASSERT_EQ(latency, 120ms);
  expectSumsToAgree();
}

TEST_F(LivePipelineTest, PresentsAtTheFirstRefreshAtOrAfterTheLatency) {
  const hal::Refresh refresh{.period = 16'666'667ns, .phase = hal::TimePoint(7ms)};
  refresh_ = refresh;
  begin({.frames = 1'000});
  live_.drain();
  EXPECT_EQ(counts().of(Outcome::kShown), 1'000u);
  for (const CapturingOutput::Note& note : live_.notes) {
    const hal::TimePoint captured = began_ + note.time;
    ASSERT_EQ((note.presented - *refresh.phase) % refresh.period, 0ns);
    ASSERT_GE(note.presented, captured + 120ms);
    ASSERT_LT(note.presented - refresh.period, captured + 120ms);
  }
}

TEST_F(LivePipelineTest, LowersQualityAndKeepsTheLatencyUnderTwiceTheLoad) {
  constexpr std::array<double, 5> kCostMs{25, 17, 11.6, 8, 5.3};
  double factor = 1.0;
  live_.gpu.cost = [&](auto, std::size_t quality) {
    return std::chrono::microseconds(
        static_cast<std::int64_t>(1000.0 * factor * kCostMs.at(quality)));
  };
  begin();
  live_.runFor(10s);
  EXPECT_EQ(status().painting.quality, 0u);
  EXPECT_EQ(counts().dropped(), 0u);

  factor = 2.6;  // 65 ms where 33 are to be had
  live_.runFor(10s);
  EXPECT_EQ(status().painting.quality, 2u) << "2.6 × 11.6 = 30 ms";
  EXPECT_LE(counts().dropped(), 6u);
  const std::uint64_t droppedInTransition = counts().dropped();

  factor = 1.0;
  live_.runFor(30s);
  EXPECT_EQ(status().painting.quality, 0u);
  EXPECT_EQ(counts().dropped(), droppedInTransition);
  EXPECT_EQ(status().painting.latencyRaised, 0u);
  for (const hal::Duration latency : latencies()) ASSERT_EQ(latency, 120ms);
  expectSumsToAgree();
}

TEST_F(LivePipelineTest, FollowsAnotherBudget) {
  constexpr std::array<int, 5> kCostMs{40, 27, 18, 12, 8};
  live_.gpu.cost = [&](auto, std::size_t quality) {
    return std::chrono::milliseconds(kCostMs.at(quality));
  };
  begin();
  live_.runFor(10s);
  EXPECT_GT(status().painting.quality, 0u);
  live_.chain->paint().setFramePeriod(100ms);
  live_.runFor(60s);
  EXPECT_EQ(status().painting.quality, 0u);
  live_.chain->paint().setFramePeriod(33'333us);
  live_.runFor(10s);
  EXPECT_GT(status().painting.quality, 0u);
  expectSumsToAgree();
}

TEST_F(LivePipelineTest, PaintsAtNoBetterLevelThanIsPermitted) {
  std::size_t best = 9;  // of the frames since it was set
  live_.gpu.cost = [&](auto, std::size_t quality) {
    best = std::min(best, quality);
    return 5ms;
  };
  begin();
  live_.runFor(5s);
  EXPECT_EQ(best, 0u) << "a control";
  live_.chain->paint().limitQuality(3);
  best = 9;
  live_.runFor(60s);
  EXPECT_EQ(best, 3u);
  EXPECT_EQ(status().painting.quality, 3u);
  EXPECT_EQ(status().painting.bestQuality, 3u);
  live_.chain->paint().limitQuality(0);
  live_.runFor(60s);
  EXPECT_EQ(status().painting.quality, 0u);
  EXPECT_EQ(status().painting.bestQuality, 0u);
  expectSumsToAgree();
}

TEST_F(LivePipelineTest, RaisesQualityAgainWithACameraThatDeliversLate) {
  hal::Duration cost = 20ms;
  live_.gpu.cost = [&](auto, std::size_t quality) { return quality == 0 ? cost : 3 * cost / 4; };
  begin({.delay = [](auto) { return 75ms; }});
  cost = 40ms;
  live_.runFor(5s);
  EXPECT_GT(status().painting.quality, 0u);
  cost = 20ms;
  live_.runFor(60s);
  EXPECT_EQ(status().painting.quality, 0u) << "95 of 120 ms, of which 75 are the camera's";
}

TEST_F(LivePipelineTest, RaisesTheLatencyOnlyWhereNothingElseHelpsAndBringsItBack) {
  hal::Duration cost = 20ms;
  live_.gpu.cost = [&](auto, auto) { return cost; };
  begin();
  live_.runFor(5s);
  cost = 110ms;  // with two in flight, ready 220 ms after they begin
  live_.runFor(10s);
  const auto busy = status().painting;
  EXPECT_EQ(busy.quality, 4u);
  EXPECT_GT(busy.latency, 200ms);
  EXPECT_LE(busy.latency, 400ms);
  EXPECT_GE(busy.latencyRaised, 1u);
  const std::size_t settled = live_.notes.size();
  const auto latencySettled = status().painting.latency;
  live_.runFor(5s);
  for (const hal::Duration each : latencies(settled)) {
    EXPECT_LE(each, latencySettled + 8ms);
  }
  EXPECT_LE(maxGap(), 230ms);

  cost = 15ms;
  live_.runFor(150s);
  EXPECT_EQ(status().painting.latency, 120ms);
  EXPECT_EQ(status().painting.quality, 0u);
  EXPECT_EQ(latencies().back(), 120ms);
  expectSumsToAgree();
}

TEST_F(LivePipelineTest, SurvivesABurstOfFiftyLateFrames) {
  live_.gpu.cost = [&](std::uint64_t sequence, auto) -> hal::Duration {
    return sequence >= 300 && sequence < 350 ? 150ms : 15ms;
  };
  begin({.frames = 3'000});
  live_.drain();
  EXPECT_LE(maxGap(), 200ms);
  EXPECT_GT(counts().dropped(), 20u);
  EXPECT_LT(counts().dropped(), 60u);
  EXPECT_EQ(latencies().back(), 120ms);
  expectSumsToAgree();
}

TEST_F(LivePipelineTest, GivesUpAPictureThatIsNeverReady) {
  live_.gpu.cost = [&](std::uint64_t sequence, auto) -> hal::Duration {
    return sequence == 100 ? 24h : 15ms;
  };
  begin({.frames = 400});
  live_.drain();
  EXPECT_EQ(status().painting.contextLosses, 1u);
  EXPECT_EQ(live_.gpu.made, 2);
  EXPECT_EQ(live_.gpu.painters, 1) << "the first one is gone";
  EXPECT_EQ(counts().of(Outcome::kContextLost), 2u) << "it, and the one behind it";
  EXPECT_LT(maxGap(), 10'500ms);
  expectSumsToAgree();
}

TEST_F(LivePipelineTest, PaintsOnWithANewContextWhenOneIsLost) {
  live_.gpu.isLostAt = [&](std::uint64_t sequence) { return sequence == 50 || sequence == 200; };
  begin({.frames = 400});
  live_.runFor(1s);
  live_.gpu.failingStarts = 2;
  live_.drain();
  EXPECT_EQ(status().painting.contextLosses, 2u);
  EXPECT_EQ(live_.gpu.made, 3);
  EXPECT_GE(counts().of(Outcome::kContextLost), 2u);
  EXPECT_GT(counts().of(Outcome::kShown), 360u);
  EXPECT_TRUE(status().painting.hasPainter);
  expectSumsToAgree();
}

TEST_F(LivePipelineTest, FinishesItsFramesBeforeAnotherPainterIsMade) {
  begin({.frames = 300});
  live_.runFor(3s);
  const int before = live_.gpu.made;
  live_.chain->paint().renew();
  EXPECT_TRUE(status().painting.isRenewing);
  live_.runFor(1s);
  EXPECT_FALSE(status().painting.isRenewing);
  EXPECT_TRUE(status().painting.hasPainter);
  live_.drain();
  EXPECT_EQ(live_.gpu.made, before + 1);
  EXPECT_EQ(status().painting.contextLosses, 0U);
  EXPECT_EQ(counts().of(Outcome::kContextLost) + counts().of(Outcome::kStopped), 0U)
      << "the old painter finished its own";
  EXPECT_GT(counts().of(Outcome::kShown), 290U);
  expectSumsToAgree();
}

TEST_F(LivePipelineTest, TriesAgainWhereAnotherPainterCannotBeMade) {
  begin({.frames = 300});
  live_.runFor(1s);
  live_.gpu.failingStarts = 2;
  live_.chain->paint().renew();
  live_.drain();
  EXPECT_TRUE(status().painting.hasPainter);
  EXPECT_FALSE(status().painting.isRenewing);
  EXPECT_GT(counts().of(Outcome::kShown), 250U);
  expectSumsToAgree();
}

TEST_F(LivePipelineTest, RecoversFromAClockThatJumps) {
  begin();
  live_.runFor(2s);
  live_.clock.advance(1h);
  live_.runFor(2s);
  EXPECT_EQ(status().painting.contextLosses, 0u) << "the GPU slept as well";
  EXPECT_GT(status().outputs[0].perSecond, 25.0);
  EXPECT_EQ(status().painting.latency, 120ms);
  expectSumsToAgree();
}

TEST_F(LivePipelineTest, NamesWhatTheCameraDidNotDeliverSoundly) {
  begin({.health =
             [](std::uint64_t sequence) {
               return sequence % 10 == 3   ? hal::FrameHealth::kCorrupt
                      : sequence % 10 == 7 ? hal::FrameHealth::kIncomplete
                                           : hal::FrameHealth::kValid;
             },
         .frames = 100});
  live_.drain();
  EXPECT_EQ(counts().of(Outcome::kCorrupt), 10u);
  EXPECT_EQ(counts().of(Outcome::kIncomplete), 10u);
  EXPECT_EQ(counts().of(Outcome::kShown), 80u);
  expectSumsToAgree();
}

TEST_F(LivePipelineTest, ShowsTheHeldFrameDuringAPause) {
  begin({.frames = 90});
  live_.runFor(1s);
  live_.chain->paint().setPaused(true);
  live_.runFor(1s);
  live_.chain->paint().setPaused(false);
  live_.drain();
  EXPECT_NEAR(static_cast<double>(counts().of(Outcome::kPaused)), 30.0, 2.0);
  EXPECT_EQ(status().outputs[0].repeats, counts().of(Outcome::kPaused));
  EXPECT_EQ(live_.notes.size(), 90u);
  expectSumsToAgree();
}

TEST_F(LivePipelineTest, ShowsPicturesAlsoWhereFewerCanWaitThanFallDue) {
  live_.painting.latency.configured = 400ms;
  waiting_ = 4;
  begin({.frames = 300});
  live_.drain();
  EXPECT_GE(counts().of(Outcome::kShown), 100u);
  EXPECT_LE(maxGap(), 300ms);
  expectSumsToAgree();
}

TEST_F(LivePipelineTest, GivesAnOutputNoMoreThanItsLimit) {
  // NOLINTNEXTLINE(modernize-make-unique): it can be neither copied nor moved
  selector_.reset(new hal::CameraSelector(support::selectorOf(
      [](hal::Clock& clock) { return std::make_unique<PacedCamera>(PacedCameraOptions{}, clock); },
      live_.clock)));
  live_.begin(*selector_);
  live_.addOutput({.name = "limited", .limit = 5});
  live_.start();
  live_.runFor(3s);
  EXPECT_TRUE(live_.chain->output(1).isFull());
  EXPECT_EQ(status().outputs[1].presented, 5u);
  EXPECT_GT(status().outputs[0].presented, 80u);
  expectSumsToAgree();
}

/// Cameras that are lost and come back.
class LostCameraTest : public LivePipelineTest {
 protected:
  void begin(std::vector<support::ScriptedSession> sessions) {
    auto backend = std::make_unique<support::ScriptedBackend>("scripted", live_.clock);
    backend->add("one", std::move(sessions));
    std::vector<hal::SelectableBackend> backends;
    backends.push_back({std::move(backend), true});
    selector_ = std::make_unique<hal::CameraSelector>(std::move(backends), "scripted", live_.clock);
    live_.begin(*selector_);
    live_.start();
  }
};

TEST_F(LostCameraTest, GoesOnWhenTheCameraIsBack) {
  const auto unplugged =
      hal::CameraLost{support::scriptedError(hal::ErrorKind::kDeviceLost, "was unplugged")};
  begin({{.startError = {}, .steps = support::scriptOf(support::scriptedFrames(60), unplugged)},
         {.startError = support::scriptedError(hal::ErrorKind::kNotFound, "is not there"),
          .steps = {}},
         {.startError = {},
          .steps = support::scriptOf(support::scriptedFrames(60), hal::EndOfStream{})}});
  live_.runFor(10s);
  EXPECT_EQ(status().camera.opens, 2u);
  EXPECT_EQ(counts().captured, 120u);
  EXPECT_EQ(counts().of(Outcome::kShown), 120u);
  expectSumsToAgree();
}

/// Only the mailbox between camera and painter replaces frames.
TEST_F(LostCameraTest, ASlowPainterReplacesFramesAndTheCameraLosesNone) {
  live_.gpu.cost = [](auto, auto) { return 100ms; };  // three frames' time
  begin({{.startError = {},
          .steps = support::scriptOf(support::scriptedFrames(90), hal::EndOfStream{})}});
  live_.runFor(5s);
  EXPECT_EQ(counts().captured, 90u);
  EXPECT_GE(counts().of(Outcome::kReplaced), 55u);
  EXPECT_EQ(counts().of(Outcome::kBufferUnderrun), 0u);
  EXPECT_EQ(counts().of(Outcome::kDroppedByDriver), 0u);
  EXPECT_EQ(counts().shown() + counts().of(Outcome::kReplaced) + counts().of(Outcome::kLate) +
                counts().of(Outcome::kSuperseded),
            90u);
  expectSumsToAgree();
}

TEST_F(LostCameraTest, ACameraWithoutABufferIsAnUnderrunAndNothingElse) {
  const support::ScriptedFrame underrun{.after = 99ms, .dropped = 2, .underruns = 2};
  begin({{.startError = {},
          .steps = support::scriptOf(support::scriptedFrames(30), underrun,
                                     support::scriptedFrames(30), underrun, hal::EndOfStream{})}});
  live_.runFor(5s);
  EXPECT_EQ(counts().captured, 66u);
  EXPECT_EQ(counts().of(Outcome::kBufferUnderrun), 4u);
  EXPECT_EQ(counts().of(Outcome::kReplaced), 0u);
  EXPECT_EQ(counts().of(Outcome::kDroppedByDriver), 0u);
  EXPECT_EQ(counts().of(Outcome::kShown), 62u);
  expectSumsToAgree();
}

TEST_F(LostCameraTest, CountsWhatWasLostInAStallApart) {
  begin({{.startError = {},
          .steps = support::scriptOf(
              support::scriptedFrames(30), support::ScriptedFrame{.after = 33ms, .dropped = 2},
              support::ScriptedSilence{1s}, support::ScriptedFrame{.after = 33ms, .dropped = 30},
              support::scriptedFrames(30), hal::EndOfStream{})}});
  live_.runFor(5s);
  EXPECT_EQ(status().camera.stalls, 1u);
  EXPECT_EQ(counts().of(Outcome::kDroppedByDriver), 2u);
  EXPECT_EQ(counts().of(Outcome::kStalled), 30u);
  EXPECT_EQ(counts().of(Outcome::kShown), 62u);
  expectSumsToAgree();
}

TEST_F(LostCameraTest, CountsBrokenFramesAlsoWhereNoSoundOneFollows) {
  const std::vector<support::ScriptedStep> broken(20, support::ScriptedFrame{.isTooShort = true});
  begin({{.startError = {}, .steps = support::scriptOf(support::scriptedFrames(10), broken)}});
  live_.runFor(2s);
  EXPECT_EQ(counts().captured, 30u);
  EXPECT_EQ(counts().of(Outcome::kCorrupt), 20u);
  expectSumsToAgree();
}

/// Random loads, delays and faults; a seed determines them.
class RandomLive : public testing::TestWithParam<unsigned> {};

struct RandomRun {
  std::vector<CapturingOutput::Note> notes;
  LedgerCounts counts;
  bool addsUp = true;
};

RandomRun runRandomly(unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  support::LiveSimulation live;
  int cost = 20'000;
  live.gpu.cost = [&](std::uint64_t, std::size_t quality) {
    if (uniform(0, 99) == 0) cost = uniform(1'000, 120'000);
    return std::chrono::microseconds(cost / static_cast<int>(quality + 1) + uniform(0, 5'000));
  };
  live.gpu.isLostAt = [&](auto) { return uniform(0, 199) == 0; };
  const support::PacedCameraOptions camera{
      .period = std::chrono::microseconds(uniform(8'000, 60'000)),
      .delay = [&](auto) { return std::chrono::microseconds(uniform(0, 30'000)); },
      .health =
          [&](auto) {
            return uniform(0, 49) == 0 ? hal::FrameHealth::kCorrupt : hal::FrameHealth::kValid;
          },
      .frames = 1'000};
  auto selector = support::selectorOf(
      [&](hal::Clock& clock) { return std::make_unique<PacedCamera>(camera, clock); }, live.clock);
  live.begin(selector);
  live.addOutput({.name = "file", .rules = {.isPaced = false}, .waiting = 3});
  live.start();
  RandomRun run;
  const auto check = [&] {
    const RuntimeStatus status = live.chain->status();
    run.addsUp = run.addsUp && status.ledger.addsUp();
    for (const auto& output : status.outputs) run.addsUp = run.addsUp && output.addsUp();
  };
  while (!live.chain->isDrained()) {
    live.runFor(std::chrono::milliseconds(50));
    check();
  }
  run.notes = live.notes;
  run.counts = live.chain->ledger().counts();
  return run;
}

TEST_P(RandomLive, KeepsItsBooks) {
  const RandomRun run = runRandomly(GetParam());
  EXPECT_TRUE(run.addsUp);
  EXPECT_EQ(run.counts.captured, 1'000u);
  EXPECT_EQ(run.counts.inFlight, 0u);
  EXPECT_GT(run.counts.shown(), 0u);
}

TEST_P(RandomLive, RepeatsToTheNanosecond) {
  const RandomRun first = runRandomly(GetParam());
  const RandomRun second = runRandomly(GetParam());
  EXPECT_EQ(first.notes, second.notes);
  EXPECT_EQ(first.counts.ended, second.counts.ended);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomLive, testing::Range(1u, 13u));

}  // namespace
}  // namespace pleinair::runtime
