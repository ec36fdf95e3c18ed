#include "hal/pixel_format.h"

#include <gtest/gtest.h>

namespace pleinair::hal {
namespace {

TEST(PixelFormat, RoundsChromaOfOddSizesUp) {
  EXPECT_EQ(rowBytes(PixelFormat::kI420, 1, 5), 3u);
  EXPECT_EQ(planeRows(PixelFormat::kI420, 2, 3), 2);
  EXPECT_EQ(rowBytes(PixelFormat::kNv12, 1, 5), 6u);
  EXPECT_EQ(planeRows(PixelFormat::kNv12, 0, 3), 3);
  EXPECT_EQ(rowBytes(PixelFormat::kYuyv, 0, 5), 12u);
  EXPECT_EQ(rowBytes(PixelFormat::kRgb8, 0, 5), 15u);
  EXPECT_EQ(rowBytes(PixelFormat::kBayerRggb8, 0, 5), 5u);
}

TEST(PixelFormat, AcceptsSizesWithinTheLimits) {
  EXPECT_TRUE(isAcceptedSize({1, 1}));
  EXPECT_TRUE(isAcceptedSize({8192, 7812}));
  EXPECT_FALSE(isAcceptedSize({8192, 7813}));
  EXPECT_FALSE(isAcceptedSize({8193, 1}));
  EXPECT_FALSE(isAcceptedSize({0, 1}));
  EXPECT_FALSE(isAcceptedSize({65535, 65535}));
}

}  // namespace
}  // namespace pleinair::hal
