// The engine's painter in the live pipeline: many frames, a lost GPU, starts and stops.
#include <atomic>
#include <chrono>

#include <gtest/gtest.h>

#include "firmware_app/live/live_painter.h"
#include "pipeline/runtime/live_pipeline.h"
#include "pipeline/styles/registry.h"
#include "tests/support/live_simulation.h"
#include "tests/support/process_resources.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;
using runtime::Outcome;
using support::ProcessResources;

constexpr hal::FrameSize kSize{160, 120};
constexpr unsigned kGuiltyContextReset = 0x8253;  // GL_GUILTY_CONTEXT_RESET

PaintParameters watercolorParameters() {
  return {.style = styles::styleKind("watercolor").defaults, .view = {}};
}

/// Live painting under a stepped clock, which stands still while the painter works.
class LiveEngine {
 public:
  explicit LiveEngine(std::uint64_t frames, PainterOptions options = {.pictureSize = kSize})
      : selector_(support::selectorOf(
            [frames](hal::Clock& clock) {
              return std::make_unique<support::PacedCamera>(
                  support::PacedCameraOptions{.frames = frames, .size = kSize}, clock);
            },
            clock_)),
        supervisor_(selector_, clock_),
        controls_({.style = "watercolor", .painting = watercolorParameters()}) {
    options.qualityLevels = true;
    while (!chain_.capture().status().format) chain_.capture().step(clock_.now());
    auto output = std::make_unique<support::CapturingOutput>(notes_, clock_);
    const auto format = *output->start({.size = kSize, .framePeriod = {}});
    chain_.addOutput(std::move(output), format, {.name = "noting", .waiting = 16});
    chain_.makePaintStage(
        [this, options] {
          return std::make_unique<LivePainter>(options, controls_, controls_.parameters());
        },
        {.governor = {.levels = qualityLevels().size(), .pinned = {}},
         .latency = {},
         .framePeriod = 33'333us});
    chain_.paint().start();
    chain_.capture().open();
  }

  runtime::LivePipeline& chain() { return chain_; }
  LiveControls& controls() { return controls_; }

  /// Steps the clock by one frame period, after frames in flight have been finished.
  void step() {
    while (chain_.paint().step() || chain_.paint().isBusy()) {
    }
    const auto wake = chain_.output(0).step();
    const hal::TimePoint frame = clock_.now() + 33ms;
    chain_.capture().step(wake ? std::clamp(*wake, clock_.now(), frame) : frame);
  }
  void drain() {
    while (!chain_.isDrained()) step();
  }
  void stop() { chain_.paint().stop(); }

 private:
  hal::SteppedClock clock_{hal::TimePoint(100s)};
  std::vector<support::CapturingOutput::Note> notes_;
  hal::CameraSelector selector_;
  hal::CameraSupervisor supervisor_;
  LiveControls controls_;
  runtime::LivePipeline chain_{supervisor_, clock_};
};

TEST(LiveEngineTest, PaintsFiveThousandFramesInTheSameMemory) {
  constexpr std::uint64_t kFrames = 5'000;
  LiveEngine live(kFrames);
  const auto captured = [&] { return live.chain().ledger().counts().captured; };
  while (captured() < kFrames / 5) live.step();
  const std::size_t resident = ProcessResources::now().residentKiB;
  const std::size_t allocated = ProcessResources::allocatedBytes();
  live.drain();
  const runtime::LedgerCounts counts = live.chain().ledger().counts();
  EXPECT_EQ(counts.captured, kFrames);
  EXPECT_EQ(counts.of(Outcome::kShown), kFrames);
  EXPECT_LE(ProcessResources::now().residentKiB, resident + 4 * 1024) << "KiB";
  // The driver's memory fluctuates; growth by 500 bytes a frame would exceed this limit.
  EXPECT_LE(ProcessResources::allocatedBytes(), allocated + 2'000'000);
}

TEST(LiveEngineTest, GoesOnWithANewContextWhenTheGpuIsLost) {
  int asked = 0;
  LiveEngine live(200, {.pictureSize = kSize, .testHook = {.resetStatus = [&asked] {
                                                return ++asked == 60 ? kGuiltyContextReset : 0u;
                                              }}});
  live.drain();
  const runtime::RuntimeStatus status = live.chain().status();
  EXPECT_EQ(status.painting.contextLosses, 1u);
  EXPECT_GE(status.ledger.of(Outcome::kContextLost), 1u);
  EXPECT_GT(status.ledger.of(Outcome::kShown), 190u);
  EXPECT_TRUE(status.ledger.addsUp());
  EXPECT_GT(asked, 150) << "the new context is asked as well";
}

TEST(LiveEngineTest, GivesTheFinishedPictureAsAStillUnderAnyView) {
  LiveEngine live(20);
  PaintParameters parameters = watercolorParameters();
  parameters.view = "cells";
  live.controls().setParameters({.style = "watercolor", .painting = parameters});
  live.step();
  live.controls().requestSnapshot();
  live.drain();
  const auto snapshot = live.controls().takeSnapshot();
  ASSERT_TRUE(snapshot);
  ASSERT_TRUE(*snapshot);
  EXPECT_EQ((*snapshot)->size(), kSize);
}

TEST(LiveEngineTest, StartsAndStopsWithoutLeavingAnything) {
  const auto cycle = [] {
    LiveEngine live(3);
    live.drain();
    live.stop();
  };
  for (int i = 0; i < 3; ++i) cycle();
  const ProcessResources before = ProcessResources::now();
  for (int i = 0; i < 25; ++i) cycle();
  const ProcessResources after = ProcessResources::now();
  EXPECT_EQ(after.descriptors, before.descriptors);
  EXPECT_EQ(after.threads, before.threads);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // both keep memory longer
  EXPECT_LE(after.residentKiB, before.residentKiB + 8 * 1024) << "KiB";
#endif
}

}  // namespace
}  // namespace pleinair::app
