#include "pipeline/gpu/context/egl_context.h"

#include <algorithm>
#include <array>
#include <latch>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/error.h"
#include "pipeline/gpu/frames/frame_upload.h"
#include "tests/support/environment.h"
#include "tests/support/gl_pictures.h"
#include "tests/support/gl_test.h"

namespace pleinair::gpu {
namespace {

using testing::HasSubstr;

class EglContextTest : public support::GlTest {};

TEST_F(EglContextTest, SaysWhatItRunsOn) {
  const ContextInfo& info = context_->info();
  EXPECT_THAT(info.version, HasSubstr("OpenGL ES 3."));
  EXPECT_FALSE(info.renderer.empty());
  EXPECT_THAT(info.platform, testing::AnyOf("surfaceless", "device", "gbm"));
  EXPECT_EQ(info.isSoftware, info.renderer.find("pipe") != std::string::npos);
  EXPECT_EQ(inspectCurrentContext("host").platform, "host");
}

TEST(InspectCurrentContext, RefusesAThreadWithoutAContext) {
  try {
    inspectCurrentContext("host");
    FAIL();
  } catch (const hal::Failure& error) {
    EXPECT_EQ(error.error().kind, hal::ErrorKind::kUnsupported);
    EXPECT_STREQ(error.what(),
                 "GPU: no context is current on this thread; make a context of OpenGL ES 3.1 or "
                 "later current");
  }
}

TEST_F(EglContextTest, KnowsTheDevicesLimit) {
  ContextInfo info = context_->info();
  EXPECT_GE(info.maxSidePixels, 2048);  // what OpenGL ES 3.1 promises
  EXPECT_TRUE(Texture(TextureFormat::kR8, {info.maxSidePixels, 1}));
  EXPECT_TRUE(checkDeviceLimit(info, {info.maxSidePixels, info.maxSidePixels}, "frame"));
  info.maxSidePixels = 4096;
  for (const hal::FrameSize size : {hal::FrameSize{4097, 1}, hal::FrameSize{1, 4097}}) {
    const auto refused = checkDeviceLimit(info, size, "frame");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, hal::ErrorKind::kUnsupported);
    EXPECT_THAT(refused.error().message(),
                testing::AllOf(HasSubstr("frame: "), HasSubstr("4097"), HasSubstr("4096 px")));
  }
}

TEST_F(EglContextTest, TakesSoftwareWhereItIsAskedFor) {
  context_.reset();
  support::setVariable("LIBGL_ALWAYS_SOFTWARE", "1");
  context_ = std::make_unique<EglContext>();
  support::setVariable("LIBGL_ALWAYS_SOFTWARE", nullptr);
  EXPECT_EQ(eglGetError(), EGL_SUCCESS);
  EXPECT_TRUE(Texture(TextureFormat::kRgba8, {1, 1}));
}

TEST_F(EglContextTest, CanBeMadeAgainAfterAnother) {
  for (int i = 0; i < 3; ++i) {
    context_.reset();
    context_ = std::make_unique<EglContext>();
    EXPECT_TRUE(Texture(TextureFormat::kRgba8, {1, 1}));
  }
}

/// The bytes that a few converted and scaled frames have.
std::vector<std::uint8_t> paintedBytes() {
  const EglContext context;
  FrameUploader uploader{ShaderLibrary{}};
  std::vector<std::uint8_t> bytes;
  for (unsigned seed = 0; seed < 5; ++seed) {
    const hal::Image frame =
        support::randomImage({.pixelFormat = hal::PixelFormat::kNv12, .size = {161, 121}}, seed);
    hal::Image result = support::readRgba8(uploader.upload(frame.view(), {100, 75}));
    bytes.insert(bytes.end(), result.plane(0).begin(), result.plane(0).end());
  }
  return bytes;
}

TEST_F(EglContextTest, PaintsTheSameOnTwoThreadsAtOnce) {
  context_.reset();
  std::array<std::vector<std::uint8_t>, 2> results;
  {
    std::jthread first([&] { results[0] = paintedBytes(); });
    std::jthread second([&] { results[1] = paintedBytes(); });
  }
  EXPECT_EQ(results[0].size(), 5U * 100 * 75 * 4);
  EXPECT_TRUE(results[0] == results[1]);
  EXPECT_TRUE(results[0] == paintedBytes());
}

TEST_F(EglContextTest, LivesOnAnotherThreadWhileTheTestHasItsOwn) {
  std::latch isMade(1);
  std::latch mayGo(1);
  std::jthread second([&] {
    const EglContext context;
    const Texture texture(TextureFormat::kRgba8, hal::FrameSize{1, 1});
    isMade.count_down();
    mayGo.wait();
  });
  isMade.wait();
  EXPECT_TRUE(Texture(TextureFormat::kRgba8, {1, 1}));
  mayGo.count_down();
}

TEST_F(EglContextTest, IsMadeCurrentAgainBesideAnotherOfTheSameThread) {
  EXPECT_TRUE(context_->isCurrent());
  {
    const CurrentContextKeeper first;
    const EglContext second;
    EXPECT_TRUE(second.isCurrent());
    EXPECT_FALSE(context_->isCurrent());
    {
      const CurrentContextKeeper keepsSecond;
      EXPECT_TRUE(context_->makeCurrent());
      EXPECT_TRUE(Texture(TextureFormat::kRgba8, {1, 1}));
    }
    EXPECT_TRUE(second.isCurrent());
  }
  EXPECT_TRUE(context_->isCurrent());
}

}  // namespace
}  // namespace pleinair::gpu
