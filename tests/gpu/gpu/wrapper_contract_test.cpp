// Contracts of the texture, target and handle wrappers, which keep the rules of docs/gpu.md where
// the software rasteriser would let them pass.
#include <array>
#include <functional>
#include <initializer_list>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/error.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"
#include "tests/support/gl_test.h"

namespace pleinair::gpu {
namespace {

using support::GlTest;
using support::readBuffer;
using support::readRgba8;

class WrapperDeathTest : public GlTest {
 protected:
  void SetUp() override {
    GTEST_FLAG_SET(death_test_style, "threadsafe");  // the driver has threads
    GlTest::SetUp();
  }
};

TEST_F(WrapperDeathTest, TexturesOfFloatsAndIntegersAreNearest) {
  for (const TextureFormat format : {TextureFormat::kR32ui, TextureFormat::kRg32ui,
                                     TextureFormat::kR32f, TextureFormat::kRgba32f}) {
    EXPECT_DEATH(Texture(format, {1, 1}, TextureFilter::kLinear), "isFilterable");
  }
}

TEST_F(WrapperDeathTest, TexturesHaveASizeAndWholeUploads) {
  EXPECT_DEATH(Texture(TextureFormat::kR8, {0, 1}), "size.width >= 1");
  Texture texture(TextureFormat::kRgba8, {2, 2});
  const std::array<std::uint8_t, 16> bytes{};
  EXPECT_DEATH(texture.upload(std::span(bytes).first(15), 8), "strideBytes");
  EXPECT_DEATH(texture.upload(bytes, 7), "strideBytes");
  Texture depth(TextureFormat::kDepth24, {2, 2});
  EXPECT_DEATH(depth.upload(bytes, 8), "kDepth24");
}

TEST_F(WrapperDeathTest, TargetsHaveFourRenderableColoursOfOneSizeAtMost) {
  const Texture a(TextureFormat::kRgba8, {4, 4});
  const Texture b(TextureFormat::kRgba16f, {4, 4});
  const Texture other(TextureFormat::kRgba8, {4, 5});
  const Texture floats(TextureFormat::kRgba32f, {4, 4});
  const Texture depth(TextureFormat::kDepth24, {4, 4});
  EXPECT_TRUE(RenderTarget({&a, &b}, &depth));
  EXPECT_DEATH(RenderTarget({&a, &b, &a, &b, &a}), "kMaxColours");
  EXPECT_DEATH(RenderTarget({&a, &other}), "colour->size\\(\\) == size_");
  EXPECT_DEATH(RenderTarget({&floats}), "isRenderable");
  EXPECT_DEATH(RenderTarget({&a}, &b), "kDepth24");
}

TEST_F(WrapperDeathTest, BuffersHoldWhatIsWritten) {
  EXPECT_DEATH(Buffer(0, BufferUsage::kStatic), "sizeBytes > 0");
  Buffer buffer(8, BufferUsage::kDynamic);
  const std::array<std::byte, 5> bytes{};
  EXPECT_DEATH(buffer.write(bytes, 4), "sizeBytes_");
}

TEST_F(WrapperDeathTest, ObjectsBelongToTheThreadOfTheirContext) {
  const Texture texture(TextureFormat::kRgba8, {1, 1});
  EXPECT_DEATH(std::thread([&] { (void)texture.name(); }).join(), "eglGetCurrentContext");
  EXPECT_DEATH(
      {
        Buffer buffer(4, BufferUsage::kStatic);
        std::thread([&] { const Buffer takenAlong = std::move(buffer); }).join();
      },
      "eglGetCurrentContext");
  EXPECT_DEATH(std::thread([&] { context_.reset(); }).join(), "eglGetCurrentContext");
}

TEST_F(WrapperDeathTest, GlErrorsAreBrokenContracts) {
  EXPECT_DEATH(glEnable(GL_TEXTURE_2D), "pleinair: GL error, a broken contract of our own");
}

class WrapperTest : public GlTest {};

TEST_F(WrapperTest, HandlesMoveAndAreEmptyWithoutAnObject) {
  Texture empty;
  EXPECT_FALSE(empty);
  Texture full(TextureFormat::kRgba8, {3, 2});
  const GLuint name = full.name();
  empty = std::move(full);
  EXPECT_TRUE(empty);
  EXPECT_EQ(empty.name(), name);
  EXPECT_EQ(empty.size(), (hal::FrameSize{3, 2}));
  const Texture moved(std::move(empty));
  EXPECT_EQ(moved.name(), name);
}

TEST_F(WrapperTest, BuffersWriteAtAnOffset) {
  const std::array<std::uint32_t, 4> before{1, 2, 3, 4};
  const std::array<std::uint32_t, 2> middle{20, 30};
  Buffer buffer = Buffer::of(std::span<const std::uint32_t>(before));
  buffer.write(std::as_bytes(std::span(middle)), 4);
  EXPECT_THAT(readBuffer<std::uint32_t>(buffer), testing::ElementsAre(1, 20, 30, 4));
}

TEST_F(WrapperTest, TargetsClearEachAttachment) {
  const Texture colour(TextureFormat::kRgba8, {2, 2});
  const Texture ids(TextureFormat::kR32ui, {2, 2});
  const Texture depth(TextureFormat::kDepth24, {2, 2});
  const RenderTarget target({&colour, &ids}, &depth);
  EXPECT_EQ(target.size(), (hal::FrameSize{2, 2}));
  target.beginDiscarding();
  target.clearColour(0, {1.0F, 0.0F, 0.2F, 1.0F});
  target.clearUnsigned(1, glm::uvec4(0xFFFFFFFFU));
  target.clearDepth();
  target.discardDepth();
  EXPECT_THAT(readRgba8(colour).row(0, 1), testing::ElementsAre(255, 0, 51, 255, 255, 0, 51, 255));
  EXPECT_THAT(support::readR32ui(ids), testing::Each(0xFFFFFFFFU));
}

TEST_F(WrapperTest, MemoryThatTheGpuLacksIsTheWorldsFailure) {
  if (!context_->info().isSoftware) GTEST_SKIP() << "a large GPU may have that much";
  constexpr int kSide = 16384;  // 4 GiB, twice what llvmpipe gives one texture
  try {
    const Texture huge(TextureFormat::kRgba32f, {kSide, kSide});
    FAIL() << "got it";
  } catch (const hal::Failure& error) {
    EXPECT_EQ(error.error().kind, hal::ErrorKind::kUnsupported);
    EXPECT_EQ(error.error().domain, hal::ErrorDomain::kGl);
    EXPECT_THAT(error.what(),
                testing::HasSubstr("the GPU has no memory for a 16384x16384 picture"));
  }
  EXPECT_TRUE(Texture(TextureFormat::kRgba8, {1, 1}));  // the context lives on
}

TEST_F(WrapperTest, FencesPass) {
  const Fence fence = Fence::insert();
  EXPECT_TRUE(fence);
  EXPECT_TRUE(fence.wait());
  EXPECT_TRUE(hal::orThrow(fence.passed()));
  EXPECT_EQ(fence.state(), FenceState::kSignalled);
}

TEST_F(WrapperTest, FencesThatFailedAreNotTakenForLateOnes) {
  const Fence lost;  // what glFenceSync gives without a GPU
  EXPECT_FALSE(lost);
  EXPECT_EQ(lost.state(), FenceState::kFailed);
  const auto passed = lost.passed();
  const auto waited = lost.wait();
  ASSERT_TRUE(passed.hasError());
  ASSERT_FALSE(waited);
  for (const hal::Error& error : {passed.error(), waited.error()}) {
    EXPECT_EQ(error.kind, hal::ErrorKind::kDeviceLost);
    EXPECT_EQ(error.domain, hal::ErrorDomain::kGl);
  }
}

}  // namespace
}  // namespace pleinair::gpu
