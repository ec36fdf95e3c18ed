#include "pipeline/runtime/output/caption.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace pleinair::runtime {
namespace {

hal::FrameFormat rgba(hal::FrameSize size) {
  return {.pixelFormat = hal::PixelFormat::kRgba8, .size = size, .encoding = {}};
}

hal::Image filled(hal::FrameSize size, std::uint8_t level) {
  hal::Image image(rgba(size));
  std::ranges::fill(image.plane(0), level);
  return image;
}

std::vector<std::uint8_t> bytesOf(hal::Image& image) {
  return {image.plane(0).begin(), image.plane(0).end()};
}

/// White, of half an opacity, in the middle of 6×4.
Caption halfWhite() {
  Caption caption{.image = filled({2, 2}, 255), .left = 3, .top = 1, .frame = rgba({6, 4})};
  for (std::size_t i = 3; i < caption.image.plane(0).size(); i += 4) {
    caption.image.plane(0)[i] = 128;
  }
  return caption;
}

TEST(CaptionOverlay, BlendsItsPixelsAlone) {
  hal::Image frame = filled({6, 4}, 100);
  CaptionOverlay overlay;
  ASSERT_TRUE(overlay.draw(frame, halfWhite(), 1.0));
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 6; ++x) {
      const bool isUnder = (x == 3 || x == 4) && (y == 1 || y == 2);
      const auto pixel = frame.row(0, y).subspan(static_cast<std::size_t>(4 * x), 4);
      EXPECT_NEAR(pixel[0], isUnder ? 178 : 100, 1) << x << ", " << y;
      EXPECT_EQ(pixel[3], 100) << "the frame's own";
    }
  }
}

TEST(CaptionOverlay, FadesWithItsOpacity) {
  hal::Image frame = filled({6, 4}, 100);
  CaptionOverlay overlay;
  ASSERT_TRUE(overlay.draw(frame, halfWhite(), 0.5));
  EXPECT_NEAR(frame.row(0, 1)[12], 139, 1);
}

TEST(CaptionOverlay, LeavesNothingBehind) {
  hal::Image frame(rgba({6, 4}));
  std::uint8_t level = 0;
  for (std::uint8_t& each : frame.plane(0)) each = level += 7;
  const std::vector<std::uint8_t> before = bytesOf(frame);
  CaptionOverlay overlay;
  const Caption caption = halfWhite();
  ASSERT_TRUE(overlay.draw(frame, caption, 1.0));
  EXPECT_NE(bytesOf(frame), before) << "a control";
  overlay.remove(frame, caption);
  EXPECT_EQ(bytesOf(frame), before);
}

TEST(CaptionOverlay, IsForFramesOfItsFormatOnly) {
  hal::Image frame = filled({4, 6}, 100);
  CaptionOverlay overlay;
  EXPECT_FALSE(overlay.draw(frame, halfWhite(), 1.0));
  EXPECT_EQ(std::ranges::count(frame.plane(0), 100), 96);
}

}  // namespace
}  // namespace pleinair::runtime
