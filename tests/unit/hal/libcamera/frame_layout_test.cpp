#include "hal/cameras/libcamera/frame_layout.h"

#include <numeric>
#include <set>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pleinair::hal::libcamera {
namespace {

constexpr std::uint32_t kNv12 = 0x3231564E;
constexpr std::uint32_t kI420 = 0x32315559;
constexpr std::uint32_t kRgb888 = 0x34324752;  // B, G, R in memory
constexpr std::uint32_t kBayer = 0x30314752;

TEST(FrameLayouts, AreDistinctAndFindable) {
  std::set<std::uint32_t> codes;
  for (const FrameLayout& each : frameLayouts()) {
    EXPECT_TRUE(codes.insert(each.fourcc).second);
    EXPECT_EQ(findLayout(each.fourcc), &each);
  }
  EXPECT_EQ(findLayout(kBayer), nullptr);
}

TEST(ChooseFormat, TakesTheRequestedFormatElseTheCheapest) {
  const std::vector<OfferedFormat> offered{
      {.fourcc = kRgb888}, {.fourcc = kBayer}, {.fourcc = kNv12}};
  EXPECT_EQ(chooseFormat(offered, {}, {})->fourcc, kNv12);
  EXPECT_EQ(chooseFormat(offered, {}, PixelFormat::kRgb8)->fourcc, kRgb888);
  EXPECT_EQ(chooseFormat(offered, {}, PixelFormat::kI420)->fourcc, kNv12) << "not offered";
  const auto none = chooseFormat(std::vector<OfferedFormat>{{.fourcc = kBayer}}, {}, {});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().remedy, testing::StartsWith("it offers RG10; raw Bayer"));
  EXPECT_EQ(chooseFormat({}, {}, {}).error().remedy, "it offers none");
}

TEST(ChooseFormat, AsksForTheSizeAsFarAsItCanBe) {
  const std::vector<OfferedFormat> offered{
      {.fourcc = kNv12, .sizes = {{320, 240}, {1280, 720}, {640, 480}}}};
  EXPECT_EQ(chooseFormat(offered, FrameSize{800, 600}, {})->size, (FrameSize{800, 600}));
  EXPECT_EQ(chooseFormat(offered, FrameSize{4000, 3000}, {})->size, (FrameSize{1280, 720}));
  EXPECT_EQ(chooseFormat(offered, {}, {})->size, (FrameSize{1280, 720}));
}

BufferMemory memoryOf(const std::vector<std::vector<std::uint8_t>>& planes) {
  BufferMemory memory;
  memory.planeCount = static_cast<int>(planes.size());
  for (std::size_t i = 0; i < planes.size(); ++i) memory.planes.at(i) = planes[i];
  return memory;
}

TEST(PlanesIn, FollowEachOtherOrAreSeparate) {
  // 4x2, stride 8: luma 16 bytes, chroma a quarter each at half the stride.
  std::vector<std::vector<std::uint8_t>> one{std::vector<std::uint8_t>(24)};
  std::iota(one.front().begin(), one.front().end(), std::uint8_t{0});
  const auto together = planesIn(memoryOf(one), *findLayout(kI420), {4, 2}, 8);
  ASSERT_TRUE(together);
  EXPECT_EQ((*together)[0].bytes.size(), 12u) << "the last row without its padding";
  EXPECT_EQ((*together)[1].bytes[0], 16);
  EXPECT_EQ((*together)[1].strideBytes, 4u);
  EXPECT_EQ((*together)[2].bytes[0], 20);
  const std::vector<std::vector<std::uint8_t>> parts{std::vector<std::uint8_t>(16, 1),
                                                     std::vector<std::uint8_t>(4, 2),
                                                     std::vector<std::uint8_t>(4, 3)};
  const auto separate = planesIn(memoryOf(parts), *findLayout(kI420), {4, 2}, 8);
  ASSERT_TRUE(separate);
  EXPECT_EQ((*separate)[2].bytes[0], 3);
}

TEST(PlanesIn, RefusesBuffersThatAreTooSmall) {
  const std::vector<std::vector<std::uint8_t>> one{std::vector<std::uint8_t>(24 - 3)};
  EXPECT_FALSE(planesIn(memoryOf(one), *findLayout(kI420), {4, 2}, 8));
  EXPECT_FALSE(planesIn(memoryOf(one), *findLayout(kI420), {4, 2}, 3)) << "a stride too short";
  EXPECT_FALSE(planesIn(BufferMemory{}, *findLayout(kNv12), {4, 2}, 4));
  // Of three rows, two strides overflow to 0.
  EXPECT_FALSE(planesIn(memoryOf(one), *findLayout(kNv12), {4, 3}, std::size_t{1} << 63));
}

TEST(SwapToRgb, ExchangesRedAndBlueOfEveryRow) {
  const std::vector<std::uint8_t> bgrx{3, 2, 1, 0, 6, 5, 4, 0, 99, 99, 9, 8, 7, 0, 12, 11, 10, 0};
  Image rgb({.pixelFormat = PixelFormat::kRgb8, .size = {2, 2}});
  swapToRgb({.bytes = bgrx, .strideBytes = 10}, 4, rgb);
  EXPECT_THAT(rgb.plane(0), testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12));
}

}  // namespace
}  // namespace pleinair::hal::libcamera
