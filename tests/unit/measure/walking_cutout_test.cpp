#include "pipeline/measure/input/walking_cutout.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <gtest/gtest.h>

#include "pipeline/measure/image_measures.h"
#include "pipeline/measure/input/picture.h"
#include "tests/unit/measure/measure_pictures.h"

namespace pleinair::measure {
namespace {

constexpr hal::FrameSize kFrame{240, 200};
const cv::Size kSize(240, 200);
constexpr hal::Duration kPeriod = std::chrono::milliseconds(100);
constexpr hal::Duration kInView = std::chrono::milliseconds(2600);

/// An ellipse with a pattern of blobs, in a transparent picture of twice its size.
hal::Image cutout() {
  const cv::Mat3f blobs = strongBlobs({160, 240}, 3);
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = {160, 240}, .encoding = {}});
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 160; ++x) {
      const bool isInside = std::hypot((x - 80) / 40.0, (y - 120) / 60.0) < 1;
      for (int c = 0; c < 3; ++c) {
        const float level = 255.0F * std::clamp(blobs(y, x)[c], 0.0F, 1.0F);
        image.row(0, y)[static_cast<std::size_t>(4 * x + c)] = static_cast<std::uint8_t>(level);
      }
      image.row(0, y)[static_cast<std::size_t>(4 * x + 3)] = isInside ? 255 : 0;
    }
  }
  return image;
}

WalkingCutout walker() {
  return {cutout(), kFrame, 100.0};
}

TEST(WalkingCutout, ComesAfterASecondAndHasGoneForOneAtTheEnd) {
  const WalkingCutout walking = walker();
  EXPECT_EQ(cv::countNonZero(walking.mask(hal::Duration(0))), 0);
  EXPECT_EQ(cv::countNonZero(walking.mask(std::chrono::milliseconds(850))), 0);
  EXPECT_GT(cv::countNonZero(walking.mask(std::chrono::milliseconds(1500))), 0);
  EXPECT_EQ(cv::countNonZero(walking.mask(walking.duration() - std::chrono::seconds(1))), 0);
}

TEST(WalkingCutout, StandsEightTenthsOfTheFrameHigh) {
  const cv::Rect around = cv::boundingRect(walker().mask(kInView));
  EXPECT_NEAR(around.height, 160, 4);
  EXPECT_EQ(around.br().y, kFrame.height) << "its foot is below the frame";
  // An ellipse of 2:3, turned a little.
  EXPECT_NEAR(around.width, 160 / 0.95 * 2 / 3, 6);
}

TEST(WalkingCutout, IsWhereItsMaskSays) {
  const WalkingCutout walking = walker();
  cv::Mat3f picture(kSize, cv::Vec3f(0, 1, 0));
  walking.drawInto(picture, kInView);
  const cv::Mat1b mask = walking.mask(kInView);
  int wrong = 0;
  for (int y = 0; y < kFrame.height; ++y) {
    for (int x = 0; x < kFrame.width; ++x) {
      const bool isGround = picture(y, x) == cv::Vec3f(0, 1, 0);
      if (isGround && mask(y, x) != 0) ++wrong;
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(cv::countNonZero(mask), 5000);
}

TEST(WalkingCutout, MovesAsItsMotionSays) {
  const WalkingCutout walking = walker();
  const auto motion = walkerMotion(walking, kSize, kPeriod);
  const auto movers = walkerMovers(walking, kPeriod);
  const auto picture = [&](int frame) {
    cv::Mat3f drawn = strongBlobs(kSize, 5);
    walking.drawInto(drawn, kPeriod * frame);
    return drawn;
  };
  const MotionMap whole = *motion->between(20, 22);
  const MotionMap map = limitedTo(movers->mask(20), whole);
  EXPECT_GT(cv::countNonZero(map.valid), 4000);
  const Mean along = warpingError(picture(20), warpedBack(picture(22), map));
  const MotionMap standing =
      limitedTo(map.valid, fieldMap(cv::Mat2f(kSize, cv::Vec2f()), cv::Mat1b(kSize, 255), 1.0F));
  const Mean asStanding = warpingError(picture(20), warpedBack(picture(22), standing));
  EXPECT_GT(*asStanding.value(), 50 * *along.value());
  const MotionMap ground = limitedTo(cv::Mat1b(movers->mask(20) == 0), whole);
  EXPECT_LT(*warpingError(picture(20), warpedBack(picture(22), ground)).value(), 1e-9);
}

TEST(WalkingCutout, IsNotSeenWhereAllIsTransparent) {
  EXPECT_TRUE(WalkingCutout::isSeen(cutout()));
  const hal::Image nothing(
      {.pixelFormat = hal::PixelFormat::kRgba8, .size = {16, 16}, .encoding = {}});
  EXPECT_FALSE(WalkingCutout::isSeen(nothing));
}

}  // namespace
}  // namespace pleinair::measure
