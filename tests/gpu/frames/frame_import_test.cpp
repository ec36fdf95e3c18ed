// Real dma-bufs, where the kernel has an allocator and the driver imports what it gives: in the
// guest, vgem and llvmpipe (tests/system/scenarios/frame_import.py).
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/frame_memory/allocators.h"
#include "hal/frame_memory/shared_frame.h"
#include "pipeline/gpu/frames/camera_frames.h"
#include "pipeline/gpu/frames/imported_texture.h"
#include "pipeline/gpu/images/pixel_comparison.h"
#include "tests/support/gl_pictures.h"
#include "tests/support/gl_test.h"

namespace pleinair::gpu {
namespace {

using hal::PixelFormat;

constexpr hal::FrameSize kImportSize{64, 48};
constexpr std::uint32_t kImportBuffers = 4;

class RealImports : public support::GlTest, public testing::WithParamInterface<PixelFormat> {
 protected:
  void SetUp() override {
    support::GlTest::SetUp();
    if (IsSkipped()) return;
    const std::string problem =
        planeImportProblem(hal::drmFourcc('R', '8', ' ', ' '), hal::kLinearModifier);
    if (!problem.empty()) GTEST_SKIP() << problem;
    for (const hal::AllocatorKind kind : hal::allAllocatorKinds()) {
      auto opened = hal::openAllocator(kind);
      if (opened) {
        allocator_ = *std::move(opened);
        return;
      }
      problems_ += opened.error().message() + "; ";
    }
    GTEST_SKIP() << "no memory to share: " << problems_;
  }
  /// Shows a picture until its memory is decided about.
  static void settle(CameraFrames& frames, const hal::CapturedFrame& frame) {
    const hal::SteadyClock clock;
    const hal::TimePoint end = clock.now() + std::chrono::seconds(100);
    do {
      frames.show(frame, kImportSize, aspectFill(kImportSize, kImportSize));
      glFinish();
      std::this_thread::yield();
    } while (frames.status().path == FramePath::kTrying && clock.now() < end);
  }

  std::shared_ptr<hal::FrameAllocator> allocator_;
  std::string problems_;
};

TEST_P(RealImports, EqualUploadsToTheBitWithoutACopy) {
  const hal::FrameFormat format{.pixelFormat = GetParam(), .size = kImportSize};
  const std::uint64_t pool = hal::nextBufferPool();
  std::vector<std::unique_ptr<hal::SharedFrame>> buffers;
  for (std::uint32_t i = 0; i < kImportBuffers; ++i) {
    buffers.push_back(hal::orThrow(hal::SharedFrame::make(*allocator_, format)));
    buffers.back()->write(support::randomImage(format, i).view());
  }
  const ShaderLibrary library;
  FrameUploader reference(library);
  // As a hardware renderer, which imports; a software renderer reads memory in place instead.
  auto info = context_->info();
  info.isSoftware = false;
  CameraFrames frames(library, info);
  settle(frames, buffers[0]->frame({.pool = pool, .index = 0}));
  RecordProperty("allocator", allocator_->name());
  ASSERT_EQ(frames.status().path, FramePath::kImported)
      << frames.status().reason << " (" << allocator_->name() << ")";
  const std::uint64_t bytes = frames.status().uploadedBytes;
  const std::uint64_t imported = frames.status().imported;
  for (unsigned i = 0; i < 20; ++i) {
    const std::uint32_t index = i % kImportBuffers;
    const hal::Image picture = support::randomImage(format, 100 + i);
    buffers[index]->write(picture.view());
    const std::vector<std::uint8_t> seen =
        pixelsOf(frames.show(buffers[index]->frame({.pool = pool, .index = index}), kImportSize,
                             aspectFill(kImportSize, kImportSize)));
    EXPECT_TRUE(seen == pixelsOf(reference.upload(picture.view(), kImportSize))) << "frame " << i;
  }
  EXPECT_EQ(frames.status().uploadedBytes, bytes);
  EXPECT_EQ(frames.status().imported, imported + 20);
}

INSTANTIATE_TEST_SUITE_P(Layouts, RealImports,
                         testing::Values(PixelFormat::kNv12, PixelFormat::kI420, PixelFormat::kYuyv,
                                         PixelFormat::kGrey8, PixelFormat::kRgb8),
                         [](const auto& each) { return std::string(toString(each.param)); });

}  // namespace
}  // namespace pleinair::gpu
