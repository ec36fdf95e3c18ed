#include "hal/image.h"

#include <vector>

#include <gtest/gtest.h>

namespace pleinair::hal {
namespace {

TEST(Image, CopiesPackedFromAnyStride) {
  std::vector<std::uint8_t> padded = {1, 2, 3, 0, 0, 4, 5, 6, 0, 0};
  const ImageView view{.format = {.pixelFormat = PixelFormat::kGrey8, .size = {3, 2}},
                       .planes = {{{.bytes = padded, .strideBytes = 5}}}};
  ASSERT_TRUE(view.isComplete());
  Image copy(view);
  EXPECT_EQ(std::vector<std::uint8_t>(copy.plane(0).begin(), copy.plane(0).end()),
            (std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6}));
  EXPECT_TRUE(copy.view().isComplete());
}

TEST(ImageView, KnowsWhenAPlaneIsTooShort) {
  std::vector<std::uint8_t> bytes(8);
  ImageView view{.format = {.pixelFormat = PixelFormat::kGrey8, .size = {3, 2}},
                 .planes = {{{.bytes = bytes, .strideBytes = 5}}}};
  EXPECT_TRUE(view.isComplete());  // the last row needs no padding
  bytes.resize(7);
  view.planes[0].bytes = bytes;
  EXPECT_FALSE(view.isComplete());
  view.planes[0].strideBytes = 2;
  EXPECT_FALSE(view.isComplete());
  view.format.size.height = 3;  // two strides overflow to 0
  view.planes[0].strideBytes = std::size_t{1} << 63;
  EXPECT_FALSE(view.isComplete());
}

TEST(Image, HasItsLumaWhereTheFormatHoldsIt) {
  const Image nv12({.pixelFormat = PixelFormat::kNv12, .size = {5, 3}});
  ASSERT_TRUE(lumaPlane(nv12.view()));
  EXPECT_EQ(lumaPlane(nv12.view())->bytes.size(), 15u);
  EXPECT_FALSE(lumaPlane(Image({.pixelFormat = PixelFormat::kRgb8, .size = {5, 3}}).view()));
}

}  // namespace
}  // namespace pleinair::hal
