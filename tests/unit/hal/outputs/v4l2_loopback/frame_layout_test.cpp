#include "hal/outputs/v4l2_loopback/frame_layout.h"

#include <cstdint>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pleinair::hal::loopback {
namespace {

using testing::ElementsAre;

FrameFormat format(PixelFormat pixelFormat, FrameSize size) {
  return {.pixelFormat = pixelFormat, .size = size, .encoding = {}};
}

TEST(FrameLayout, IsPackedWithoutAStride) {
  const auto yuyv = FrameLayout::of(format(PixelFormat::kYuyv, {6, 4}), 0);
  ASSERT_TRUE(yuyv);
  EXPECT_EQ(yuyv->bytes, 6u * 2 * 4);
  const auto nv12 = FrameLayout::of(format(PixelFormat::kNv12, {6, 4}), 0);
  ASSERT_TRUE(nv12);
  EXPECT_THAT(nv12->offsetBytes, ElementsAre(0, 24, 0));
  EXPECT_EQ(nv12->bytes, 36u);
  const auto i420 = FrameLayout::of(format(PixelFormat::kI420, {6, 4}), 0);
  ASSERT_TRUE(i420);
  EXPECT_THAT(i420->offsetBytes, ElementsAre(0, 24, 30));
  EXPECT_EQ(i420->bytes, 36u);
}

TEST(FrameLayout, GivesChromaItsShareOfAStride) {
  const auto nv12 = FrameLayout::of(format(PixelFormat::kNv12, {6, 4}), 8);
  ASSERT_TRUE(nv12);
  EXPECT_THAT(nv12->strideBytes, ElementsAre(8, 8, 0));
  EXPECT_EQ(nv12->bytes, 48u);
  const auto i420 = FrameLayout::of(format(PixelFormat::kI420, {6, 4}), 8);
  ASSERT_TRUE(i420);
  EXPECT_THAT(i420->strideBytes, ElementsAre(8, 4, 4));
  EXPECT_THAT(i420->offsetBytes, ElementsAre(0, 32, 40));
  EXPECT_EQ(i420->bytes, 48u);
}

TEST(FrameLayout, RefusesAStrideThatIsTooShort) {
  EXPECT_FALSE(FrameLayout::of(format(PixelFormat::kYuyv, {6, 4}), 11));
  EXPECT_FALSE(FrameLayout::of(format(PixelFormat::kNv12, {6, 4}), 5));
  EXPECT_FALSE(FrameLayout::of(format(PixelFormat::kI420, {7, 4}), 7)) << "chroma needs 4 of 3.5";
}

TEST(FrameLayout, PacksPlaneAfterPlaneAndLeavesThePadding) {
  const FrameFormat i420 = format(PixelFormat::kI420, {4, 2});
  Image picture(i420);
  const std::vector<std::uint8_t> luma{1, 2, 3, 4, 5, 6, 7, 8};
  std::ranges::copy(luma, picture.plane(0).begin());
  picture.plane(1)[0] = 11;
  picture.plane(1)[1] = 12;
  picture.plane(2)[0] = 21;
  picture.plane(2)[1] = 22;
  const auto layout = FrameLayout::of(i420, 6);
  ASSERT_TRUE(layout);
  std::vector<std::uint8_t> frame(layout->bytes, 99);
  layout->pack(picture.view(), frame);
  EXPECT_THAT(frame, ElementsAre(1, 2, 3, 4, 99, 99, 5, 6, 7, 8, 99, 99,  //
                                 11, 12, 99, 21, 22, 99));
}

}  // namespace
}  // namespace pleinair::hal::loopback
