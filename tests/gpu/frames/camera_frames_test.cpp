// How camera frames reach the GPU, with buffers that stand for imported ones.
#include "pipeline/gpu/frames/camera_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/gpu/frames/imported_texture.h"
#include "pipeline/gpu/images/pixel_comparison.h"
#include "tests/gpu/frames/shared_buffers.h"
#include "tests/support/gl_test.h"

namespace pleinair::gpu {
namespace {

using hal::PixelFormat;
using support::randomImage;
using support::SharedBuffers;
using testing::HasSubstr;

constexpr hal::FrameSize kSize{38, 22};
constexpr std::uint32_t kBuffers = 4;

class CameraFramesTest : public support::GlTest {
 protected:
  GpuTestHook hookOf(SharedBuffers& buffers) {
    GpuTestHook hook;
    hook.importPlane = [&buffers](const hal::GpuSurface& surface) {
      return buffers.import(surface);
    };
    return hook;
  }
  std::unique_ptr<CameraFrames> framesOf(SharedBuffers& buffers) {
    return std::make_unique<CameraFrames>(library_, context_->info(), hookOf(buffers));
  }
  static hal::FrameFormat formatOf(PixelFormat layout) {
    return {.pixelFormat = layout, .size = kSize};
  }
  std::vector<std::uint8_t> uploaded(const hal::ImageView& image) {
    return pixelsOf(reference().upload(image, image.format.size));
  }
  std::vector<std::uint8_t> shown(CameraFrames& frames, const hal::CapturedFrame& frame) {
    const hal::FrameSize size = frame.image.format.size;
    return pixelsOf(frames.show(frame, size, aspectFill(size, size)));
  }
  /// Shows frame `number` in the next buffer, and compares it with an upload.
  void expectRight(CameraFrames& frames, SharedBuffers& buffers, unsigned number) {
    const std::uint32_t index = number % kBuffers;
    const hal::Image picture = randomImage(buffers.at(index).format(), number + 1);
    buffers.write(index, picture);
    EXPECT_TRUE(shown(frames, buffers.frame(index)) == uploaded(picture.view()))
        << "frame " << number;
  }
  FrameUploader& reference() {
    if (!reference_) reference_ = std::make_unique<FrameUploader>(library_);
    return *reference_;
  }
  void TearDown() override { reference_.reset(); }

  ShaderLibrary library_;
  std::unique_ptr<FrameUploader> reference_;
};

class ImportedFrames : public CameraFramesTest, public testing::WithParamInterface<PixelFormat> {};

TEST_P(ImportedFrames, EqualUploadedOnesToTheBitWithoutACopy) {
  SharedBuffers buffers(formatOf(GetParam()), kBuffers);
  const auto frames = framesOf(buffers);
  for (unsigned i = 0; i < 20; ++i) expectRight(*frames, buffers, i);
  const FramePathStatus& status = frames->status();
  EXPECT_EQ(status.path, FramePath::kImported) << status.reason;
  EXPECT_EQ(status.imported, 20u);
  EXPECT_EQ(status.uploaded, 0u);
  EXPECT_EQ(status.uploadedBytes, 0u);
  EXPECT_EQ(buffers.imports, static_cast<int>(kBuffers) * planeCount(GetParam()))
      << "each buffer once";
}

INSTANTIATE_TEST_SUITE_P(Layouts, ImportedFrames,
                         testing::Values(PixelFormat::kNv12, PixelFormat::kI420, PixelFormat::kYuyv,
                                         PixelFormat::kGrey8, PixelFormat::kRgb8,
                                         PixelFormat::kRgba8, PixelFormat::kBayerGrbg8),
                         [](const auto& each) {
                           std::string name(toString(each.param));
                           std::erase(name, '-');
                           return name;
                         });

TEST_F(CameraFramesTest, FramesOfOrdinaryMemoryAreUploaded) {
  SharedBuffers buffers(formatOf(PixelFormat::kNv12), kBuffers);
  const auto frames = framesOf(buffers);
  const hal::Image picture = randomImage(formatOf(PixelFormat::kNv12));
  const hal::CapturedFrame frame{.image = picture.view()};
  EXPECT_EQ(shown(*frames, frame), uploaded(picture.view()));
  EXPECT_EQ(frames->status().path, FramePath::kUploaded);
  EXPECT_THAT(frames->status().reason, HasSubstr("no memory that it shares"));
  EXPECT_EQ(frames->status().uploadedBytes, 38u * 22u + 38u * 11u);
}

TEST_F(CameraFramesTest, AnImportThatReportsSuccessWithOtherPixelsIsRefused) {
  SharedBuffers buffers(formatOf(PixelFormat::kNv12), kBuffers);
  buffers.isWrong = true;
  const auto frames = framesOf(buffers);
  for (unsigned i = 0; i < 6; ++i) expectRight(*frames, buffers, i);
  EXPECT_EQ(frames->status().path, FramePath::kUploaded);
  EXPECT_THAT(frames->status().reason, HasSubstr("other pixels"));
  EXPECT_EQ(frames->status().imported, 0u);
}

TEST_F(CameraFramesTest, AnImportThatIsASnapshotIsRefusedOnceABufferComesRound) {
  SharedBuffers buffers(formatOf(PixelFormat::kGrey8), kBuffers);
  const auto frames = framesOf(buffers);
  for (unsigned i = 0; i < kBuffers; ++i) expectRight(*frames, buffers, i);
  EXPECT_EQ(frames->status().path, FramePath::kImported);
  buffers.isStale = true;
  for (unsigned i = kBuffers; i < 12; ++i) expectRight(*frames, buffers, i);
  EXPECT_EQ(frames->status().path, FramePath::kUploaded);
  EXPECT_THAT(frames->status().reason, HasSubstr("other pixels"));
}

TEST_F(CameraFramesTest, AnImportThatIsRefusedLateGoesOnWithUploads) {
  SharedBuffers buffers(formatOf(PixelFormat::kI420), kBuffers);
  buffers.refusesFrom = 7;  // in the middle of the third buffer
  const auto frames = framesOf(buffers);
  for (unsigned i = 0; i < 10; ++i) expectRight(*frames, buffers, i);
  EXPECT_EQ(frames->status().path, FramePath::kUploaded);
  EXPECT_THAT(frames->status().reason, HasSubstr("makes no image of the camera's memory"));
  EXPECT_EQ(frames->status().imported, 2u);
  EXPECT_EQ(frames->status().uploaded, 8u);
}

TEST_F(CameraFramesTest, AnUnknownModifierIsNotEvenTried) {
  SharedBuffers buffers(formatOf(PixelFormat::kNv12), kBuffers);
  const auto frames = framesOf(buffers);
  const hal::Image picture = randomImage(formatOf(PixelFormat::kNv12));
  buffers.write(0, picture);
  hal::CapturedFrame frame = buffers.frame(0);
  frame.modifier = 0x0100000000000001;
  EXPECT_EQ(shown(*frames, frame), uploaded(picture.view()));
  EXPECT_THAT(frames->status().reason, HasSubstr("0x0100000000000001"));
  EXPECT_EQ(buffers.imports, 0);
}

TEST_F(CameraFramesTest, WithoutTheExtensionFramesAreUploaded) {
  SharedBuffers buffers(formatOf(PixelFormat::kNv12), kBuffers);
  CameraFrames frames(library_, context_->info());
  if (planeImportProblem(hal::drmFourcc('R', '8', ' ', ' '), hal::kLinearModifier).empty()) {
    GTEST_SKIP() << "this driver imports dma-bufs: the guest has vgem";
  }
  expectRight(frames, buffers, 0);
  EXPECT_EQ(frames.status().path, FramePath::kUploaded);
  EXPECT_THAT(frames.status().reason, HasSubstr("EGL_EXT_image_dma_buf_import"));
}

TEST_F(CameraFramesTest, ABlankPictureProvesNothingAndIsWaitedOut) {
  SharedBuffers buffers(formatOf(PixelFormat::kNv12), kBuffers);
  const auto frames = framesOf(buffers);
  hal::Image black(formatOf(PixelFormat::kNv12));
  std::ranges::fill(black.plane(0), std::uint8_t{16});
  std::ranges::fill(black.plane(1), std::uint8_t{128});
  buffers.write(0, black);
  shown(*frames, buffers.frame(0));
  EXPECT_EQ(frames->status().path, FramePath::kTrying);
  EXPECT_EQ(frames->status().uploaded, 1u);
  expectRight(*frames, buffers, 1);
  EXPECT_EQ(frames->status().path, FramePath::kImported);
}

TEST_F(CameraFramesTest, ANewStreamIsTriedAgainAndNothingOldIsRead) {
  SharedBuffers first(formatOf(PixelFormat::kNv12), kBuffers);
  const auto frames = framesOf(first);
  for (unsigned i = 0; i < 6; ++i) expectRight(*frames, first, i);
  // The same numbers of buffers and descriptors, in another pool: nothing kept may be used.
  SharedBuffers second(formatOf(PixelFormat::kNv12), kBuffers);
  const int before = first.imports;
  const hal::Image picture = randomImage(formatOf(PixelFormat::kNv12), 99);
  second.write(1, picture);
  first.write(1, picture);  // what an import of that number gives
  EXPECT_EQ(shown(*frames, second.frame(1)), uploaded(picture.view()));
  EXPECT_GT(first.imports, before);
}

TEST_F(CameraFramesTest, AFormatThatChangesInMidStreamIsFollowed) {
  SharedBuffers nv12(formatOf(PixelFormat::kNv12), kBuffers);
  SharedBuffers grey({.pixelFormat = PixelFormat::kGrey8, .size = {17, 9}}, kBuffers);
  SharedBuffers* now = &nv12;
  GpuTestHook hook;
  hook.importPlane = [&](const hal::GpuSurface& surface) { return now->import(surface); };
  CameraFrames frames(library_, context_->info(), hook);
  for (unsigned i = 0; i < 6; ++i) expectRight(frames, nv12, i);
  now = &grey;
  for (unsigned i = 0; i < 6; ++i) expectRight(frames, grey, i);
  EXPECT_EQ(frames.status().path, FramePath::kImported);
  EXPECT_EQ(frames.status().imported, 12u);
}

TEST_F(CameraFramesTest, LeasesAreHeldUntilTheGpuHasReadAndNoLonger) {
  SharedBuffers buffers(formatOf(PixelFormat::kNv12), kBuffers);
  const auto frames = framesOf(buffers);
  for (unsigned i = 0; i < 6; ++i) expectRight(*frames, buffers, i);
  glFinish();
  frames->releaseRead();
  auto lease = std::make_shared<int>(0);
  const std::weak_ptr<int> watched = lease;
  const hal::Image picture = randomImage(formatOf(PixelFormat::kNv12), 7);
  buffers.write(2, picture);
  frames->show(buffers.frame(2, std::move(lease)), kSize, aspectFill(kSize, kSize));
  EXPECT_FALSE(watched.expired()) << "its pass is only issued";
  EXPECT_EQ(frames->status().heldLeases, 1u);
  glFinish();
  frames->releaseRead();
  EXPECT_TRUE(watched.expired());
  EXPECT_EQ(frames->status().heldLeases, 0u);
}

TEST_F(CameraFramesTest, WhileTheGpuHoldsEnoughBuffersFramesAreUploaded) {
  SharedBuffers buffers(formatOf(PixelFormat::kGrey8), 8);
  GpuTestHook hook = hookOf(buffers);
  bool isSlow = false;
  hook.waitForFence = [&](std::uint64_t) -> unsigned {
    return isSlow ? GL_TIMEOUT_EXPIRED : GL_ALREADY_SIGNALED;
  };
  CameraFrames frames(library_, context_->info(), hook);
  for (unsigned i = 0; i < 9; ++i) {
    buffers.write(i % 8, randomImage(formatOf(PixelFormat::kGrey8), i));
    shown(frames, buffers.frame(i % 8));
  }
  isSlow = true;
  const std::uint64_t before = frames.status().imported;
  for (unsigned i = 0; i < 6; ++i) {
    const hal::Image picture = randomImage(formatOf(PixelFormat::kGrey8), 50 + i);
    buffers.write(i, picture);
    EXPECT_EQ(shown(frames, buffers.frame(i)), uploaded(picture.view())) << i;
  }
  EXPECT_LE(frames.status().imported - before, CameraFrames::kMostHeld);
  EXPECT_EQ(frames.status().heldLeases, CameraFrames::kMostHeld);
  EXPECT_EQ(frames.status().path, FramePath::kImported) << "that is no fault of the memory";
  isSlow = false;
}

TEST_F(CameraFramesTest, ACopyThatTheCameraMadeIsUploadedAndForgotten) {
  SharedBuffers buffers(formatOf(PixelFormat::kNv12), kBuffers);
  const auto frames = framesOf(buffers);
  for (unsigned i = 0; i < 5; ++i) expectRight(*frames, buffers, i);
  const hal::Image picture = randomImage(formatOf(PixelFormat::kNv12), 70);
  EXPECT_EQ(shown(*frames, hal::CapturedFrame{.image = picture.view()}), uploaded(picture.view()));
  const int before = buffers.imports;
  for (unsigned i = 5; i < 9; ++i) expectRight(*frames, buffers, i);
  EXPECT_EQ(buffers.imports, before) << "what was imported is kept";
  EXPECT_EQ(frames->status().path, FramePath::kImported);
}

}  // namespace
}  // namespace pleinair::gpu
