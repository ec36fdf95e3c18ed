// Two hours of frames at 30 a second through the runtime, under a stepped clock.
#include <cstdint>

#include <gtest/gtest.h>

#include "tests/support/live_simulation.h"
#include "tests/support/pass_through_painter.h"
#include "tests/support/process_resources.h"

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;
using support::ProcessResources;

/// Takes images and keeps none.
class ForgettingOutput final : public hal::MemoryOutput {
 public:
  hal::OutputIdentity identity() const override { return {"forgetting", "forgetting"}; }
  hal::Result<hal::OutputFormat> start(const hal::OutputRequest& request) override {
    return hal::OutputFormat{
        .frame = {.pixelFormat = hal::PixelFormat::kGrey8, .size = request.size, .encoding = {}},
        .refresh = {}};
  }
  hal::Result<void> write(const hal::ImageView&, hal::Duration) override { return {}; }
  hal::Result<void> finish() override { return {}; }
};

TEST(Soak, TwoHoursOfFramesLeaveMemoryFlat) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer keeps freed memory in quarantine";
#endif
  constexpr std::uint64_t kFrames = 216'000;
  constexpr hal::FrameSize kSize{160, 120};
  hal::SteppedClock clock{hal::TimePoint(100s)};
  auto selector = support::selectorOf(
      [=](hal::Clock& cameraClock) {
        return std::make_unique<support::PacedCamera>(
            support::PacedCameraOptions{.frames = kFrames, .size = kSize}, cameraClock);
      },
      clock);
  hal::CameraSupervisor supervisor(selector, clock);
  LivePipeline chain(supervisor, clock);
  while (!chain.capture().status().format) chain.capture().step(clock.now());
  for (const char* name : {"one", "other"}) {
    auto output = std::make_unique<ForgettingOutput>();
    const auto format = *output->start({.size = kSize, .framePeriod = {}});
    chain.addOutput(std::move(output), format, {.name = name, .waiting = 16});
  }
  chain.makePaintStage(
      [] { return std::make_unique<support::PassThroughPainter>(); },
      {.governor = {.levels = 5, .pinned = {}}, .latency = {}, .framePeriod = 33'333us});
  chain.paint().start();
  chain.capture().open();

  std::size_t resident = 0;
  std::size_t allocated = 0;
  while (!chain.isDrained()) {
    std::optional<hal::TimePoint> wake;
    do {
      wake.reset();
      for (std::size_t i = 0; i < chain.outputCount(); ++i) {
        if (const auto next = chain.output(i).step()) wake = wake ? std::min(*wake, *next) : next;
      }
    } while (chain.paint().step());
    chain.capture().step(std::min(wake.value_or(clock.now() + 33ms), clock.now() + 33ms));
    if (resident == 0 && chain.ledger().counts().captured > kFrames / 10) {
      resident = ProcessResources::now().residentKiB;
      allocated = ProcessResources::allocatedBytes();
    }
  }
  const LedgerCounts counts = chain.ledger().counts();
  EXPECT_EQ(counts.captured, kFrames);
  EXPECT_EQ(counts.of(Outcome::kShown), kFrames);
  EXPECT_TRUE(counts.addsUp());
  EXPECT_LE(ProcessResources::now().residentKiB, resident + 512) << "KiB";
  EXPECT_LE(ProcessResources::allocatedBytes(), allocated + 16 * 1024);
}

}  // namespace
}  // namespace pleinair::runtime
