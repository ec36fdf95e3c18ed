// The live pipeline on its threads and the real clock: stages that block, hang, come, go or
// are stopped at any moment. No result depends on the speed of the machine; waits have generous
// limits.
#include "pipeline/runtime/live_threads.h"

#include <chrono>
#include <future>
#include <semaphore>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/live_simulation.h"
#include "tests/support/pass_through_painter.h"
#include "tests/support/process_resources.h"

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;
using support::PacedCamera;
using support::PassThroughPainter;
using support::ProcessResources;

/// Counts its images, and blocks on request.
class BlockingOutput final : public hal::MemoryOutput {
 public:
  struct Control {
    std::atomic<int> written = 0;  ///< notified
    std::atomic<bool> blocks = false;
    std::atomic<bool> finished = false;
    std::binary_semaphore blocked{0};  ///< released when a write begins to block
    std::binary_semaphore release{0};
  };
  explicit BlockingOutput(Control& control) : control_(control) {}
  hal::OutputIdentity identity() const override { return {"blocking", "blocking"}; }
  hal::Result<hal::OutputFormat> start(const hal::OutputRequest& request) override {
    return hal::OutputFormat{
        .frame = {.pixelFormat = hal::PixelFormat::kGrey8, .size = request.size, .encoding = {}},
        .refresh = {}};
  }
  hal::Result<void> write(const hal::ImageView&, hal::Duration) override {
    if (control_.blocks) {
      control_.blocked.release();
      control_.release.acquire();
    }
    ++control_.written;
    control_.written.notify_all();
    return {};
  }
  hal::Result<void> finish() override {
    control_.finished = true;
    return {};
  }

 private:
  Control& control_;
};

/// A live pipeline with a paced camera, a painter that copies frames, and outputs that may block.
class Live {
 public:
  explicit Live(std::size_t outputs, hal::Duration period = 4ms)
      : selector_(support::selectorOf(
            [period](hal::Clock& clock) {
              return std::make_unique<PacedCamera>(
                  support::PacedCameraOptions{.period = period, .delay = noDelay}, clock);
            },
            clock_)),
        supervisor_(selector_, clock_),
        chain_(supervisor_, clock_),
        threads_(chain_),
        controls_(outputs) {
    while (!chain_.capture().status().format) std::this_thread::sleep_for(1ms);
    for (BlockingOutput::Control& control : controls_) {
      auto output = std::make_unique<BlockingOutput>(control);
      const hal::OutputFormat format = formatOf(*output);
      chain_.addOutput(std::move(output), format, options());
    }
    chain_.makePaintStage([] { return std::make_unique<PassThroughPainter>(); },
                          {.governor = {.levels = 5, .pinned = {}},
                           .latency = {.configured = 20ms},
                           .framePeriod = period});
    threads_.startPainter();
    while (!threads_.isPainterReady()) std::this_thread::sleep_for(1ms);
    threads_.startOutputs();
  }

  LivePipeline& chain() { return chain_; }
  BlockingOutput::Control& output(std::size_t index) { return controls_.at(index); }
  LiveThreads& threads() { return threads_; }
  LiveThreads::Stopped stop(hal::Duration patience = 20s) { return threads_.stop(patience); }
  /// Adds an output while frames flow; its control has the next index.
  OutputStage& add() {
    auto output = std::make_unique<BlockingOutput>(controls_.emplace_back());
    const hal::OutputFormat format = formatOf(*output);
    return threads_.addOutput(std::move(output), format, options());
  }
  /// Returns when the output has got `count` more images. Only the test's time limit ends it
  /// sooner.
  void awaitPictures(std::size_t index, int count) {
    std::atomic<int>& written = output(index).written;
    const int wanted = written + count;
    for (int now = written; now < wanted; now = written) written.wait(now);
  }
  void waitForPictures(std::size_t index, int count) {
    const int wanted = output(index).written + count;
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    while (output(index).written < wanted && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(1ms);
    }
    ASSERT_GE(output(index).written, wanted);
  }

 private:
  static hal::Duration noDelay(std::uint64_t) { return hal::Duration{0}; }
  static hal::OutputFormat formatOf(hal::Output& output) {
    return *output.start({.size = {8, 6}, .framePeriod = {}});
  }
  static OutputStageOptions options() { return {.name = "output", .waiting = 8}; }

  hal::SteadyClock clock_;
  hal::CameraSelector selector_;
  hal::CameraSupervisor supervisor_;
  LivePipeline chain_;
  LiveThreads threads_;
  std::deque<BlockingOutput::Control> controls_;
};

TEST(LiveThreadsTest, OneOutputThatStallsDoesNotSlowTheOther) {
  Live live(2);
  live.waitForPictures(1, 5);
  live.output(0).blocks = true;
  const int before = live.output(0).written;
  live.waitForPictures(1, 200);
  EXPECT_LE(live.output(0).written, before + 1);
  const RuntimeStatus status = live.chain().status();
  EXPECT_TRUE(status.outputs[0].addsUp());
  EXPECT_GT(status.outputs[0].ended.at(static_cast<std::size_t>(Outcome::kOutputBusy)), 100u);
  live.output(0).blocks = false;
  live.output(0).release.release();
  live.waitForPictures(0, 5);
  EXPECT_TRUE(live.stop().stuck.empty());
  EXPECT_TRUE(live.chain().ledger().counts().addsUp());
  EXPECT_EQ(live.chain().ledger().counts().inFlight, 0u);
}

TEST(LiveThreadsTest, LeavesBehindAnOutputThatNeverComesBack) {
  Live live(2);
  live.waitForPictures(1, 5);
  live.output(0).blocks = true;
  live.waitForPictures(1, 20);
  const LiveThreads::Stopped stopped = live.stop(1s);
  EXPECT_THAT(stopped.stuck, testing::ElementsAre("output 0"));
  EXPECT_TRUE(live.output(1).finished) << "the other one is completed";
  live.output(0).blocks = false;  // so that this test can end
  live.output(0).release.release();
  EXPECT_TRUE(live.stop().stuck.empty());
}

/// Each frame of each output, and each frame of the ledger, has an outcome or is in flight.
void expectSumsToAgree(const LivePipeline& chain) {
  const RuntimeStatus status = chain.status();
  EXPECT_TRUE(status.ledger.addsUp());
  for (const OutputStage::Status& output : status.outputs) EXPECT_TRUE(output.addsUp());
}

TEST(LiveThreadsTest, OutputsComeAndGoWhileFramesFlow) {
  Live live(1);
  OutputStage& first = live.chain().output(0);
  live.awaitPictures(0, 5);
  OutputStage& second = live.add();
  live.awaitPictures(1, 5);
  live.awaitPictures(0, 5);
  EXPECT_EQ(live.chain().status().outputs.size(), 2u);
  expectSumsToAgree(live.chain());

  live.threads().removeOutput(first);
  const auto removed = live.threads().takeRemoved(60s);
  ASSERT_TRUE(removed.has_value());
  EXPECT_EQ(removed->output.get(), &first);
  EXPECT_FALSE(removed->failure.has_value());
  EXPECT_TRUE(live.output(0).finished);
  const OutputStage::Status ended = removed->output->status();
  EXPECT_TRUE(ended.addsUp());
  EXPECT_EQ(ended.waiting, 0u);
  EXPECT_EQ(ended.presented, static_cast<std::uint64_t>(live.output(0).written));
  EXPECT_FALSE(live.threads().takeRemoved().has_value());

  live.awaitPictures(1, 20);
  EXPECT_EQ(ended.presented, static_cast<std::uint64_t>(live.output(0).written));
  EXPECT_EQ(live.chain().outputCount(), 1u);
  expectSumsToAgree(live.chain());

  EXPECT_TRUE(live.stop().stuck.empty());
  EXPECT_TRUE(live.output(1).finished);
  EXPECT_EQ(second.status().waiting, 0u);
  expectSumsToAgree(live.chain());
  const LedgerCounts ledger = live.chain().ledger().counts();
  EXPECT_EQ(ledger.inFlight, 0u);
  // The ledger counts a frame once that both outputs have shown.
  const std::uint64_t other = second.status().presented;
  EXPECT_GE(ledger.shown(), std::max(ended.presented, other));
  EXPECT_LE(ledger.shown(), ended.presented + other);
}

TEST(LiveThreadsTest, ARemovedOutputThatBlocksHoldsUpNoOther) {
  Live live(2);
  live.awaitPictures(0, 1);
  live.output(0).blocks = true;
  live.output(0).blocked.acquire();
  live.threads().removeOutput(live.chain().output(0));
  live.awaitPictures(1, 100);
  EXPECT_FALSE(live.output(0).finished);
  EXPECT_FALSE(live.threads().takeRemoved().has_value());
  live.output(0).blocks = false;
  live.output(0).release.release();
  EXPECT_TRUE(live.threads().takeRemoved(60s).has_value());
  EXPECT_TRUE(live.output(0).finished);
  EXPECT_TRUE(live.stop().stuck.empty());
  EXPECT_EQ(live.chain().ledger().counts().inFlight, 0u);
}

TEST(LiveThreadsTest, OutputsThatComeAndGoAHundredTimesLeaveNothing) {
  Live live(1, 1ms);
  live.awaitPictures(0, 1);
  const ProcessResources before = ProcessResources::now();
  for (std::size_t i = 1; i <= 100; ++i) {
    OutputStage& added = live.add();
    if (i % 2 == 0) live.awaitPictures(i, 2);  // otherwise it may go before the painter knows it
    live.threads().removeOutput(added);
    if (i % 4 == 0) continue;  // taken later, with the next
    const auto removed = live.threads().takeRemoved(60s);
    ASSERT_TRUE(removed.has_value());
    ASSERT_TRUE(removed->output->status().addsUp());
  }
  while (live.chain().outputCount() > 1) {
    ASSERT_TRUE(live.threads().takeRemoved(60s).has_value());
  }
  live.awaitPictures(0, 5);  // a joined thread leaves /proc a little later
  EXPECT_EQ(ProcessResources::now().threads, before.threads);
  // A removed output that nobody takes is ended by stop().
  live.threads().removeOutput(live.add());
  EXPECT_TRUE(live.stop().stuck.empty());
  expectSumsToAgree(live.chain());
  EXPECT_EQ(live.chain().ledger().counts().inFlight, 0u);
}

TEST(LiveThreadsTest, StartsAndStopsAHundredTimesWithoutLeavingAnything) {
  {
    Live warmUp(2);
    warmUp.waitForPictures(0, 1);
    warmUp.stop();
  }
  std::this_thread::sleep_for(200ms);  // a joined thread leaves /proc a little later
  const ProcessResources before = ProcessResources::now();
  const std::size_t allocated = ProcessResources::allocatedBytes();
  for (int i = 0; i < 100; ++i) {
    Live live(2, 1ms);
    if (i % 2 == 0) live.waitForPictures(0, 3);  // and at once
    ASSERT_TRUE(live.stop().stuck.empty());
    ASSERT_EQ(live.chain().ledger().counts().inFlight, 0u);
    ASSERT_TRUE(live.chain().ledger().counts().addsUp());
  }
  std::this_thread::sleep_for(200ms);
  const ProcessResources after = ProcessResources::now();
  EXPECT_EQ(after.descriptors, before.descriptors);
  EXPECT_EQ(after.threads, before.threads);
  EXPECT_LT(ProcessResources::allocatedBytes(), allocated + 64 * 1024);
}

TEST(LiveThreadsTest, TellsWhatThePainterFailedWithAtTheStart) {
  hal::SteadyClock clock;
  auto selector = support::selectorOf(
      [](hal::Clock& cameraClock) {
        return std::make_unique<PacedCamera>(support::PacedCameraOptions{}, cameraClock);
      },
      clock);
  hal::CameraSupervisor supervisor(selector, clock);
  LivePipeline chain(supervisor, clock);
  LiveThreads threads(chain);
  BlockingOutput::Control control;
  chain.addOutput(std::make_unique<BlockingOutput>(control), {}, {.name = "output"});
  chain.makePaintStage(
      []() -> std::unique_ptr<FramePainter> {
        throw hal::Failure({.kind = hal::ErrorKind::kUnsupported,
                            .subject = "GPU",
                            .problem = "is not there",
                            .remedy = {}});
      },
      {});
  threads.startPainter();
  const auto waitForPainter = [&] {
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    while (!threads.isPainterReady() && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(1ms);
    }
  };
  EXPECT_THROW(waitForPainter(), hal::Failure);
  EXPECT_TRUE(threads.stop(20s).stuck.empty());
}

}  // namespace
}  // namespace pleinair::runtime
