// Where trackers have the luma of a frame from: a second stream, the frame, the GPU, or a copy.
#include "pipeline/engine/frame_luma.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/tracking/motion/image_motion_estimator.h"
#include "tests/gpu/frames/shared_buffers.h"
#include "tests/gpu/painter/painter_fixture.h"
#include "tests/support/gl_test.h"
#include "tests/support/textured_plane.h"

namespace pleinair {
namespace {

using namespace std::chrono_literals;
using hal::PixelFormat;
using support::SharedBuffers;
using testing::HasSubstr;

constexpr hal::FrameFormat kFormat{.pixelFormat = PixelFormat::kNv12, .size = {64, 48}};
constexpr std::uint32_t kBuffers = 4;

/// Memory that takes the processor so long to read, by the test's clock.
class SlowMemory final : public hal::ReadAccess {
 public:
  SlowMemory(hal::SteppedClock& clock, hal::Duration time) : clock_(clock), time_(time) {}
  void beginRead() const override {
    ++reads;
    clock_.advance(time_);
  }
  void endRead() const override {}
  mutable int reads = 0;

 private:
  hal::SteppedClock& clock_;
  hal::Duration time_;
};

class FrameLumaTest : public support::GlTest {
 protected:
  /// Frames come in memory that takes `copy` to read, from a GPU that takes `gpu` to give its luma.
  void make(hal::Duration copy, hal::Duration gpu) {
    memory_.emplace(clock_, copy);
    hook_.importPlane = [this](const hal::GpuSurface& surface) { return buffers_.import(surface); };
    hook_.waitForFence = nullptr;  // leases are held as long as the GPU truly reads
    frames_.emplace(library_, context_->info(), hook_);
    hook_.waitForFence = [this, gpu](std::uint64_t timeoutNs) {
      const auto limit = hal::Duration(static_cast<std::int64_t>(timeoutNs));
      clock_.advance(std::min(gpu, limit));
      if (gpu > limit) return unsigned{GL_TIMEOUT_EXPIRED};
      glFinish();
      return unsigned{GL_CONDITION_SATISFIED};
    };
    luma_.emplace(library_, context_->info(), hook_, clock_);
  }

  /// Shows and takes frame `number`, and compares its luma.
  LumaSource take(unsigned number, bool needsWhole = true) {
    const std::uint32_t index = number % kBuffers;
    const hal::Image picture = support::randomImage(kFormat, number + 1);
    buffers_.write(index, picture);
    hal::CapturedFrame frame = buffers_.frame(index);
    frame.image = hal::FrameImage(buffers_.at(index).view(), &*memory_);
    frame.luma = second_;
    frames_->show(frame, kFormat.size, gpu::aspectFill(kFormat.size, kFormat.size));
    memory_->reads = 0;
    const auto mapped = luma_->take(frame, *frames_, needsWhole);
    if (luma_->source() != LumaSource::kSecondStream) expectRight(picture);
    return luma_->source();
  }
  void expectRight(const hal::Image& picture) {
    const hal::PlaneView& luma = luma_->luma().luma();
    for (int y = 0; y < kFormat.size.height; ++y) {
      const auto row = picture.view().row(0, y);
      EXPECT_TRUE(std::ranges::equal(
          luma.bytes.subspan(static_cast<std::size_t>(y) * luma.strideBytes, row.size()), row))
          << "row " << y;
    }
  }
  void TearDown() override {
    luma_.reset();
    frames_.reset();
  }

  hal::SteppedClock clock_;
  gpu::ShaderLibrary library_;
  gpu::GpuTestHook hook_;
  SharedBuffers buffers_{kFormat, kBuffers};
  std::optional<SlowMemory> memory_;
  std::optional<hal::FrameImage> second_;
  std::optional<gpu::CameraFrames> frames_;
  std::optional<FrameLuma> luma_;
};

TEST_F(FrameLumaTest, IsReadBackWhereTheProcessorReadsSlowly) {
  make(5ms, 1ms);
  for (unsigned i = 0; i < FrameLuma::kRounds; ++i) {
    EXPECT_EQ(take(i), LumaSource::kCopy) << "the trial's frames are copied: " << i;
  }
  for (unsigned i = FrameLuma::kRounds; i < 20; ++i) {
    EXPECT_EQ(take(i), LumaSource::kReadback) << i << ": " << luma_->reason();
    EXPECT_EQ(memory_->reads, 0) << "the processor does not touch the memory";
  }
  EXPECT_EQ(luma_->reason(), "the GPU takes 1.00 ms, a copy 5.00 ms");
}

TEST_F(FrameLumaTest, IsCopiedWhereThatIsAsQuick) {
  make(1900us, 1ms);  // less than half the time is gained
  for (unsigned i = 0; i < 20; ++i) EXPECT_EQ(take(i), LumaSource::kCopy) << i;
  EXPECT_EQ(luma_->reason(), "the GPU takes 1.00 ms, a copy 1.90 ms");
}

TEST_F(FrameLumaTest, IsCopiedOnceTheGpuIsLateAgainAndAgain) {
  make(50ms, 9ms);
  for (unsigned i = 0; i < FrameLuma::kRounds; ++i) take(i);
  EXPECT_EQ(take(9), LumaSource::kReadback);
  luma_.reset();
  make(50ms, 11ms);  // later than a frame's luma may be
  for (unsigned i = 0; i < FrameLuma::kRounds; ++i) take(i);
  for (unsigned i = 9; i < 14; ++i) EXPECT_EQ(take(i), LumaSource::kCopy) << i;
  EXPECT_THAT(luma_->reason(), HasSubstr("late"));
}

TEST_F(FrameLumaTest, IsCopiedWhereTheGpuReadsOtherPixels) {
  make(5ms, 1ms);
  for (unsigned i = 0; i < 6; ++i) take(i);
  buffers_.isStale = true;  // a snapshot; CameraFrames has confirmed the memory before
  for (unsigned i = 6; i < 12; ++i) EXPECT_EQ(take(i), LumaSource::kCopy) << i;
  EXPECT_THAT(luma_->reason(), HasSubstr("other pixels"));
}

TEST_F(FrameLumaTest, IsCopiedWhereFramesAreUploaded) {
  make(5ms, 1ms);
  hook_.importPlane = nullptr;
  frames_.emplace(library_, context_->info(), hook_);
  for (unsigned i = 0; i < 12; ++i) EXPECT_EQ(take(i), LumaSource::kCopy) << i;
  EXPECT_THAT(luma_->reason(), HasSubstr("does not read the camera's memory"));
}

TEST_F(FrameLumaTest, ComesFromASecondStreamUnlessWholeFramesAreNeeded) {
  make(5ms, 1ms);
  const hal::Image small =
      support::randomImage({.pixelFormat = PixelFormat::kGrey8, .size = {32, 24}});
  second_ = small.view();
  EXPECT_EQ(take(0, true), LumaSource::kCopy);
  EXPECT_EQ(take(1, false), LumaSource::kSecondStream);
  EXPECT_EQ(memory_->reads, 0) << "the frame's own memory is not touched";
  EXPECT_EQ(luma_->luma().size(), kFormat.size) << "motion is told in px of the frame";
  EXPECT_EQ(luma_->reason(), "the camera makes 32x24 px beside frames of 64x48 px");
}

hal::Image wall(hal::FrameSize size, int number) {
  const double scale = 320.0 / size.width;
  glm::dmat3 wallFromFrame(scale);
  wallFromFrame[2] = {4.0 * number, 0.0, 1.0};
  return support::renderWall({.size = size, .wallFromFrame = wallFromFrame});
}

/// A wall that moves by 4 px a frame, followed in a second image of half the size.
TEST_F(FrameLumaTest, OfASecondStreamTellsMotionInPxOfTheFrame) {
  make(5ms, 1ms);
  tracking::ImageMotionEstimator estimator;
  for (int number = 0; number < 5; ++number) {
    const hal::Image whole = wall({320, 240}, number);
    const hal::Image small = wall({160, 120}, number);
    hal::CapturedFrame frame{.image = whole.view(), .luma = small.view()};
    const auto mapped = luma_->take(frame, *frames_, false);
    const tracking::ImageMotion& motion =
        estimator.follow(luma_->luma(), static_cast<std::uint64_t>(number));
    EXPECT_EQ(motion.frameSize, (hal::FrameSize{320, 240}));
    if (number < 2) continue;  // the first frames may still be held
    ASSERT_TRUE(motion.picture) << number;
    const glm::dvec3 moved = motion.picture->currentFromPrevious * glm::dvec3(160, 120, 1);
    EXPECT_NEAR(moved.x / moved.z, 156.0, 0.1) << number;
    EXPECT_NEAR(moved.y / moved.z, 120.0, 0.1) << number;
  }
}

class LumaPath : public PainterTest {
 protected:
  static LumaSource of(const char* style, bool tracksTags) {
    Painter painter({.pictureSize = {64, 48}, .style = style, .tracksTags = tracksTags});
    hal::CapturedFrame frame = frameOf(wall({320, 240}, 0), 0);
    const hal::Image small = wall({160, 120}, 0);
    frame.luma = small.view();
    painted(painter, frame);
    return painter.cameraPath().luma;
  }
};

TEST_F(LumaPath, IsASecondStreamsUnlessTagsAreLookedFor) {
  EXPECT_EQ(of("watercolor", false), LumaSource::kSecondStream);
  EXPECT_EQ(of("none", true), LumaSource::kInPlace);
  EXPECT_EQ(of("none", false), LumaSource::kNone);
}

}  // namespace
}  // namespace pleinair
