// The GPU's way to a frame's luma, with buffers that stand for imported ones.
#include "pipeline/gpu/images/luma_readback.h"

#include <algorithm>
#include <chrono>

#include <gtest/gtest.h>

#include "pipeline/gpu/frames/camera_frames.h"
#include "pipeline/tracking/image/luma.h"
#include "tests/gpu/frames/shared_buffers.h"
#include "tests/support/gl_test.h"

namespace pleinair::gpu {
namespace {

using namespace std::chrono_literals;
using hal::PixelFormat;
using support::randomImage;
using support::SharedBuffers;

constexpr std::uint32_t kLumaBuffers = 4;

struct LumaCase {
  PixelFormat layout;
  hal::FrameSize size;
};

class LumaReadbacks : public support::GlTest, public testing::WithParamInterface<LumaCase> {
 protected:
  ShaderLibrary library_;
};

TEST_P(LumaReadbacks, EqualTheProcessorsToTheBit) {
  const hal::FrameFormat format{.pixelFormat = GetParam().layout, .size = GetParam().size};
  SharedBuffers buffers(format, kLumaBuffers);
  GpuTestHook hook;
  hook.importPlane = [&](const hal::GpuSurface& surface) { return buffers.import(surface); };
  CameraFrames frames(library_, context_->info(), hook);
  LumaReadback readback(library_);
  tracking::LumaConverter converter;
  hal::Image read;
  for (unsigned i = 0; i < 6; ++i) {
    const hal::Image picture = randomImage(format, i + 1);
    buffers.write(i % kLumaBuffers, picture);
    frames.show(buffers.frame(i % kLumaBuffers), format.size, aspectFill(format.size, format.size));
    ASSERT_FALSE(frames.importedPlanes().empty()) << frames.status().reason;
    readback.begin(format, frames.importedPlanes());
    frames.holdLonger();
    ASSERT_TRUE(hal::orThrow(readback.finish(read, 10s)));
    ASSERT_EQ(read.format(), (hal::FrameFormat{PixelFormat::kGrey8, format.size, {}}));
    const hal::PlaneView luma = converter.convert(picture.view());
    for (int y = 0; y < format.size.height; ++y) {
      const auto row = read.row(0, y);
      const auto right =
          luma.bytes.subspan(static_cast<std::size_t>(y) * luma.strideBytes, row.size());
      ASSERT_TRUE(std::ranges::equal(row, right)) << "frame " << i << ", row " << y;
    }
  }
}

// Also widths that fill no whole texel.
INSTANTIATE_TEST_SUITE_P(Layouts, LumaReadbacks,
                         testing::Values(LumaCase{PixelFormat::kNv12, {38, 22}},
                                         LumaCase{PixelFormat::kI420, {37, 21}},
                                         LumaCase{PixelFormat::kYuyv, {38, 22}},
                                         LumaCase{PixelFormat::kGrey8, {39, 5}},
                                         LumaCase{PixelFormat::kRgb8, {161, 121}},
                                         LumaCase{PixelFormat::kRgba8, {160, 120}}),
                         [](const auto& each) {
                           std::string name(toString(each.param.layout));
                           std::erase(name, '-');
                           return name;
                         });

TEST_F(LumaReadbacks, ReadNoMosaics) {
  EXPECT_FALSE(LumaReadback::canRead(PixelFormat::kBayerRggb8));
  EXPECT_TRUE(LumaReadback::canRead(PixelFormat::kNv12));
}

TEST_F(LumaReadbacks, ThatAreLateAreNotReady) {
  GpuTestHook hook;
  hook.waitForFence = [](std::uint64_t) { return unsigned{GL_TIMEOUT_EXPIRED}; };
  LumaReadback readback(library_, hook);
  const hal::FrameFormat format{.pixelFormat = PixelFormat::kGrey8, .size = {16, 8}};
  const std::array planes{Texture(TextureFormat::kR8, format.size)};
  readback.begin(format, planes);
  hal::Image read;
  EXPECT_FALSE(hal::orThrow(readback.finish(read, 1ms)));
  EXPECT_EQ(read.format().size, hal::FrameSize{}) << "nothing was copied";
}

}  // namespace
}  // namespace pleinair::gpu
