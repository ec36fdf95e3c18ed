// The live chain on its threads, in real time: what each is given ends, whatever the others do.
// Runs until its frames are over, at whatever speed; the thread sanitizer sees here what happens
// between the stages.
#include "pipeline/runtime/live_threads.h"

#include <algorithm>
#include <atomic>
#include <deque>
#include <future>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/runtime/status_text.h"
#include "tests/support/live_simulation.h"

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;
using support::PacedCamera;
using support::PacedCameraOptions;
using testing::Contains;
using testing::IsEmpty;

constexpr hal::FrameSize kSize{32, 24};
/// For what ends anyway.
constexpr hal::Duration kPatience = 60s;

hal::Error errorOf(hal::ErrorKind kind, std::string problem) {
  return {.kind = kind, .subject = "test", .problem = std::move(problem)};
}

/// Fills each picture with its frame's number, at once. Loses its GPU once where that is asked for.
class StampingPainter final : public FramePainter {
 public:
  StampingPainter(const std::vector<hal::FrameFormat>& formats, std::atomic<bool>& loses)
      : formats_(formats), loses_(loses), painted_(formats.size()) {}

  hal::Result<void> paint(const hal::CapturedFrame& frame, std::size_t) override {
    if (loses_.exchange(false)) {
      return tl::unexpected(errorOf(hal::ErrorKind::kDeviceLost, "lost"));
    }
    for (auto& each : painted_) each.push_back({frame.sequence, frame.captureTime});
    return {};
  }
  hal::Result<bool> take(std::size_t output, ReadPicture& picture) override {
    if (painted_.at(output).empty()) return false;
    const Painted next = painted_.at(output).front();
    painted_.at(output).pop_front();
    if (picture.image.format() != formats_.at(output)) picture.image = hal::Image(formats_[output]);
    std::ranges::fill(picture.image.plane(0), static_cast<std::uint8_t>(next.sequence));
    picture.sequence = next.sequence;
    picture.captureTime = next.captured;
    return true;
  }

 private:
  struct Painted {
    std::uint64_t sequence = 0;
    hal::TimePoint captured;
  };
  std::vector<hal::FrameFormat> formats_;
  std::atomic<bool>& loses_;
  std::vector<std::deque<Painted>> painted_;
};

/// Counts whole pictures.
class CheckingOutput final : public hal::MemoryOutput {
 public:
  struct Seen {
    std::atomic<std::uint64_t> whole = 0, torn = 0;
    std::atomic<bool> fails = false;      ///< every write
    std::shared_future<void> holdsUntil;  ///< each write waits for it, where there is one
  };
  explicit CheckingOutput(Seen& seen) : seen_(seen) {}

  hal::OutputIdentity identity() const override { return {"checking", "checking"}; }
  hal::Result<hal::OutputFormat> start(const hal::OutputRequest& request) override {
    return hal::OutputFormat{
        .frame = {.pixelFormat = hal::PixelFormat::kGrey8, .size = request.size}};
  }
  hal::Result<void> write(const hal::ImageView& picture, hal::Duration) override {
    if (seen_.holdsUntil.valid()) seen_.holdsUntil.wait();
    if (seen_.fails) return tl::unexpected(errorOf(hal::ErrorKind::kIo, "is full"));
    const auto bytes = picture.planes[0].bytes;
    const bool isWhole = std::ranges::all_of(bytes, [&](auto byte) { return byte == bytes[0]; });
    ++(isWhole ? seen_.whole : seen_.torn);
    return {};
  }
  hal::Result<void> finish() override { return {}; }

 private:
  Seen& seen_;
};

class LiveThreadsTest : public testing::Test {
 protected:
  void begin(std::optional<std::uint64_t> frames) {
    const PacedCameraOptions options{
        .period = 1ms, .delay = [](auto) { return 0ms; }, .frames = frames, .size = kSize};
    selector_.reset(new hal::CameraSelector(support::selectorOf(
        [options](hal::Clock& clock) { return std::make_unique<PacedCamera>(options, clock); },
        clock_)));
    supervisor_ = std::make_unique<hal::CameraSupervisor>(*selector_, clock_);
    chain_ = std::make_unique<LiveChain>(*supervisor_, clock_);
    threads_ = std::make_unique<LiveThreads>(*chain_);
    while (!chain_->capture().status().format) std::this_thread::yield();
  }
  void addOutput(CheckingOutput::Seen& seen, bool isPaced) {
    auto output = std::make_unique<CheckingOutput>(seen);
    const auto format = *output->start({.size = kSize});
    OutputStageOptions options{.name = "checking", .rules = {.isPaced = isPaced}};
    chain_->addOutput(std::move(output), format, std::move(options));
  }
  void startPainter() {
    PaintStageOptions options{.governor = {.levels = 5, .pinned = {}},
                              .latency = {.configured = 5ms},
                              .framePeriod = 1ms,
                              .refresh = {}};
    chain_->makePaintStage(
        [this](const std::vector<hal::FrameFormat>& formats) -> std::unique_ptr<FramePainter> {
          if (!hasGpu_) throw hal::StartupError(errorOf(hal::ErrorKind::kUnsupported, "no GPU"));
          return std::make_unique<StampingPainter>(formats, losesGpu_);
        },
        options);
    threads_->startPainter();
    while (!threads_->isPainterReady()) std::this_thread::yield();
  }
  void expectAllEnded() const {
    const RuntimeStatus status = chain_->status();
    EXPECT_EQ(status.ledger.underWay, 0u);
    EXPECT_TRUE(status.ledger.addsUp());
    for (const OutputStage::Status& output : status.outputs) EXPECT_TRUE(output.addsUp());
  }

  hal::SteadyClock clock_;
  std::atomic<bool> hasGpu_ = true;
  std::atomic<bool> losesGpu_ = false;
  std::unique_ptr<hal::CameraSelector> selector_;
  std::unique_ptr<hal::CameraSupervisor> supervisor_;
  std::unique_ptr<LiveChain> chain_;
  std::unique_ptr<LiveThreads> threads_;
};

TEST_F(LiveThreadsTest, EndsEveryFrameWhileOthersLookOn) {
  begin(300);
  CheckingOutput::Seen stepped, paced, unpaced;
  addOutput(stepped, true);
  addOutput(paced, true);
  addOutput(unpaced, false);
  startPainter();
  losesGpu_ = true;
  std::jthread onlooker([this](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      const RuntimeStatus status = chain_->status();
      EXPECT_TRUE(status.ledger.addsUp());
      EXPECT_FALSE(statusJson(status, {"0", "1", "2", "3", "4"}).empty());
    }
  });
  threads_->startOutputs({0});
  bool isPaused = false;
  while (!chain_->isDrained()) {
    chain_->paint().setPaused(isPaused = !isPaused);
    chain_->output(0).wait(chain_->output(0).step());
  }
  onlooker = {};
  const LiveThreads::Stopped stopped = threads_->stop(kPatience);
  EXPECT_THAT(stopped.stuck, IsEmpty());
  EXPECT_THAT(stopped.failures, IsEmpty());
  expectAllEnded();
  EXPECT_EQ(chain_->ledger().counts().captured, 300u);
  EXPECT_EQ(chain_->status().painting.contextLosses, 1u);
  EXPECT_EQ(stepped.torn + paced.torn + unpaced.torn, 0u);
}

TEST_F(LiveThreadsTest, StopsInTheMiddleOfAnEndlessStream) {
  begin(std::nullopt);
  CheckingOutput::Seen sound, failing;
  failing.fails = true;
  addOutput(sound, true);
  addOutput(failing, false);
  startPainter();
  threads_->startOutputs();
  while (sound.whole < 5 || !chain_->output(1).status().isFinal) std::this_thread::yield();
  const LiveThreads::Stopped stopped = threads_->stop(kPatience);
  EXPECT_THAT(stopped.stuck, IsEmpty());
  ASSERT_EQ(stopped.failures.size(), 1u);
  EXPECT_EQ(stopped.failures[0].problem, "is full");
  expectAllEnded();
  EXPECT_EQ(sound.torn, 0u);
}

TEST_F(LiveThreadsTest, TellsWhyThereIsNoPainter) {
  begin(std::nullopt);
  CheckingOutput::Seen seen;
  addOutput(seen, true);
  hasGpu_ = false;
  EXPECT_THROW(startPainter(), hal::StartupError);
  EXPECT_THAT(threads_->stop(kPatience).stuck, IsEmpty());
  expectAllEnded();
}

TEST_F(LiveThreadsTest, NamesAnOutputThatHangs) {
  begin(std::nullopt);
  std::promise<void> released;
  CheckingOutput::Seen hanging, sound;
  hanging.holdsUntil = released.get_future().share();
  addOutput(hanging, false);
  addOutput(sound, true);
  startPainter();
  threads_->startOutputs();
  while (sound.whole < 5) std::this_thread::yield();
  EXPECT_THAT(threads_->stop(200ms).stuck, Contains("output 0"));
  released.set_value();
  EXPECT_THAT(threads_->stop(kPatience).stuck, IsEmpty());
  expectAllEnded();
}

}  // namespace
}  // namespace pleinair::runtime
