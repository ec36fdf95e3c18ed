// One output's stage under a stepped clock: failures, reopening, skipping.
#include "pipeline/runtime/output/output_stage.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;

constexpr hal::FrameFormat kFormat{.pixelFormat = hal::PixelFormat::kGrey8, .size = {8, 6}};

/// The behaviour of a device; shared by the outputs that open it one after another.
struct Device {
  bool isBroken = false;  ///< write() fails
  bool isFull = false;    ///< write() skips
  bool isGone = false;    ///< start() fails
  hal::FrameFormat format = kFormat;
  int opened = 0;
  int written = 0;
};

class DeviceOutput final : public hal::MemoryOutput {
 public:
  explicit DeviceOutput(Device& device) : device_(device) {}
  hal::OutputIdentity identity() const override { return {"device", "device"}; }
  hal::Result<hal::OutputFormat> start(const hal::OutputRequest&) override {
    if (device_.isGone) return tl::unexpected(error("is not there"));
    ++device_.opened;
    return hal::OutputFormat{.frame = device_.format, .refresh = {}};
  }
  hal::Result<void> write(const hal::ImageView&, hal::Duration) override {
    if (device_.isBroken) return tl::unexpected(error("cannot write"));
    if (device_.isFull) {
      ++skipped_;
    } else {
      ++device_.written;
    }
    return {};
  }
  std::uint64_t skippedPictures() const override { return skipped_; }
  hal::Result<void> finish() override { return {}; }

 private:
  static hal::Error error(std::string problem) {
    return {.kind = hal::ErrorKind::kDeviceLost,
            .subject = "device",
            .problem = std::move(problem),
            .remedy = {}};
  }
  Device& device_;
  std::uint64_t skipped_ = 0;
};

class OutputStageTest : public testing::Test {
 protected:
  void begin(bool reopens) {
    OutputStageOptions options{.name = "device"};
    if (reopens) {
      options.reopen = [this]() -> hal::Result<std::unique_ptr<hal::Output>> {
        return std::make_unique<DeviceOutput>(device_);
      };
    }
    auto output = std::make_unique<DeviceOutput>(device_);
    const auto format = output->start({});
    if (!format) {
      output.reset();
      options.absence = format.error();
    }
    stage_ = std::make_unique<OutputStage>(std::move(output),
                                           format.value_or(hal::OutputFormat{.frame = kFormat}),
                                           std::move(options), clock_, ledger_);
  }
  /// Submits so many frames, all on time.
  void run(int frames) {
    for (int i = 0; i < frames; ++i) {
      const hal::TimePoint now = clock_.now();
      OutputFrame& picture = stage_->buffer();
      picture.image = hal::Image(submitted_);
      picture.captureTime = now;
      stage_->submit(ledger_.open(), now, 10ms);
      for (const hal::TimePoint end = now + 33ms; clock_.now() < end;) {
        const auto next = stage_->step();
        clock_.sleepUntil(next ? std::clamp(*next, clock_.now() + 1ms, end) : end);
      }
    }
  }
  std::uint64_t of(Outcome outcome) const { return ledger_.counts().of(outcome); }
  void expectSumsToAgree() const {
    EXPECT_TRUE(ledger_.counts().addsUp());
    EXPECT_TRUE(stage_->status().addsUp());
  }

  hal::SteppedClock clock_{hal::TimePoint(100s)};
  FrameLedger ledger_;
  hal::FrameFormat submitted_ = kFormat;
  Device device_;
  std::unique_ptr<OutputStage> stage_;
};

TEST_F(OutputStageTest, OpensADeviceAnewOnceItIsBack) {
  begin(true);
  run(30);
  device_.isBroken = device_.isGone = true;
  run(30);
  EXPECT_TRUE(stage_->status().isFailed);
  EXPECT_FALSE(stage_->status().isFinal);
  EXPECT_EQ(of(Outcome::kOutputFailed), 30u);
  device_.isBroken = device_.isGone = false;
  run(90);
  EXPECT_FALSE(stage_->status().isFailed);
  EXPECT_EQ(device_.opened, 2);
  EXPECT_EQ(static_cast<std::uint64_t>(device_.written), of(Outcome::kShown));
  EXPECT_GT(of(Outcome::kShown), 80u);
  expectSumsToAgree();
}

TEST_F(OutputStageTest, KeepsNoFramesThatComeWhileItFails) {
  begin(true);
  run(2);
  device_.isBroken = device_.isGone = true;
  run(2);
  ASSERT_TRUE(stage_->status().isFailed);
  std::set<const OutputFrame*> buffers;
  for (int i = 0; i < 10; ++i) {  // while its thread opens the device, which may take long
    OutputFrame& picture = stage_->buffer();
    buffers.insert(&picture);
    picture.image = hal::Image(submitted_);
    picture.captureTime = clock_.now();
    stage_->submit(ledger_.open(), clock_.now(), 10ms);
  }
  EXPECT_EQ(buffers.size(), 1u);
  expectSumsToAgree();
}

TEST_F(OutputStageTest, TriesLessAndLessOftenWhereWhatOpensTakesNoPicture) {
  begin(true);
  device_.isBroken = true;
  run(30 * 60);  // a minute
  EXPECT_EQ(device_.opened, 15) << "at first; after 0.5, 1, 2, 4 s; then each 5 s";
  expectSumsToAgree();
}

TEST_F(OutputStageTest, TakesFramesOfTheNewFormatOnlyOnceADeviceHasAnother) {
  begin(true);
  run(1);
  device_.isBroken = true;
  run(1);
  device_.isBroken = false;
  device_.format.size.width = 16;
  run(30);  // still of the format before
  EXPECT_FALSE(stage_->status().isFailed);
  EXPECT_EQ(stage_->format().frame, device_.format);
  EXPECT_EQ(device_.written, 1);
  submitted_ = device_.format;
  run(30);
  EXPECT_EQ(device_.written, 31);
  expectSumsToAgree();
}

TEST_F(OutputStageTest, WaitsForADeviceThatIsNotThereYet) {
  device_.isGone = true;
  begin(true);
  run(30);
  EXPECT_TRUE(stage_->status().isFailed);
  EXPECT_FALSE(stage_->status().isFinal);
  EXPECT_EQ(stage_->status().failure->problem, "is not there");
  device_.isGone = false;
  run(90);
  EXPECT_GT(device_.written, 60);
  expectSumsToAgree();
}

TEST_F(OutputStageTest, TriesAtOnceWhenADeviceHasCome) {
  device_.isGone = true;
  begin(true);
  run(20 * 30);
  device_.isGone = false;
  stage_->retry();
  run(1);
  EXPECT_EQ(device_.opened, 1);
}

TEST_F(OutputStageTest, EndsForGoodWhatCannotBeOpenedAnew) {
  begin(false);
  device_.isBroken = true;
  run(3);
  EXPECT_TRUE(stage_->status().isFinal);
  EXPECT_EQ(of(Outcome::kOutputFailed), 3u);
  const auto finished = stage_->finish();
  ASSERT_FALSE(finished);
  EXPECT_EQ(finished.error().problem, "cannot write");
  expectSumsToAgree();
}

TEST_F(OutputStageTest, CallsNoPictureShownThatTheDeviceSkipped) {
  begin(true);
  run(5);
  device_.isFull = true;
  run(5);
  EXPECT_EQ(of(Outcome::kShown), 5u);
  EXPECT_EQ(of(Outcome::kOutputBusy), 5u);
  EXPECT_EQ(stage_->status().presented, 5u);
  EXPECT_EQ(stage_->status().skipped, 5u);
  EXPECT_FALSE(stage_->status().isFailed);
  expectSumsToAgree();
}

TEST_F(OutputStageTest, FailsWhereThePainterRefusesItAsItIs) {
  const hal::Error refusal{.kind = hal::ErrorKind::kUnsupported, .subject = "GPU"};
  begin(true);
  hal::FrameFormat another = kFormat;
  another.size.width *= 2;
  stage_->refuse({.frame = another}, refusal);
  EXPECT_FALSE(stage_->isRefused()) << "that was another display";
  stage_->refuse({.frame = kFormat}, refusal);
  EXPECT_TRUE(stage_->isRefused());
  stage_->step();
  EXPECT_TRUE(stage_->status().isFailed);
  EXPECT_EQ(stage_->status().failure->subject, "GPU");
  stage_->retry();
  stage_->step();
  EXPECT_FALSE(stage_->isRefused());
  EXPECT_FALSE(stage_->status().isFailed);
}

TEST_F(OutputStageTest, KeepsItsOwnReasonWhereItIsNotThereYet) {
  device_.isGone = true;
  begin(true);
  stage_->refuse({.frame = kFormat}, {.kind = hal::ErrorKind::kUnsupported, .subject = "GPU"});
  stage_->step();
  EXPECT_EQ(stage_->status().failure->subject, "device");
  device_.isGone = false;
  clock_.advance(1s);
  stage_->step();
  stage_->step();
  EXPECT_FALSE(stage_->status().isFailed) << "it was refused before it was there";
}

TEST_F(OutputStageTest, OpensNothingMoreAtTheEnd) {
  begin(true);
  device_.isBroken = true;
  run(1);
  clock_.advance(10s);
  EXPECT_FALSE(stage_->finish());
  EXPECT_EQ(device_.opened, 1);
}

}  // namespace
}  // namespace pleinair::runtime
