#include "pipeline/runtime/output/fade_in.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;

constexpr hal::TimePoint kStart{100s};
constexpr hal::FrameSize kSize{16, 4};

hal::Image filled(std::uint8_t level, hal::FrameSize size = kSize) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = size, .encoding = {}});
  for (int y = 0; y < size.height; ++y) {
    const auto row = image.row(0, y);
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = i % 4 == 3 ? 255 : level;
  }
  return image;
}

std::uint8_t levelOf(hal::Image& image) {
  return image.row(0, 1)[4];
}

TEST(FadeIn, LeavesFramesAloneUnlessItIsOn) {
  FadeIn fade;
  hal::Image frame = filled(200);
  EXPECT_TRUE(fade.apply(frame, kStart));
  EXPECT_EQ(levelOf(frame), 200);
}

TEST(FadeIn, RisesMonotonicallyFromThePictureToTheFrameToTheBit) {
  FadeIn fade;
  fade.begin(std::make_shared<hal::Image>(filled(40)));
  std::vector<std::uint8_t> levels;
  hal::TimePoint due = kStart;
  for (; due < kStart + 2s; due += 20ms) {
    hal::Image frame = filled(200);
    const bool isWhole = fade.apply(frame, due);
    levels.push_back(levelOf(frame));
    EXPECT_EQ(isWhole, !fade.isOn());
    EXPECT_EQ(frame.row(0, 0)[3], 255) << "opaque all the time";
    if (isWhole) break;
  }
  EXPECT_LT(levels.front(), 60) << "it begins near the picture";
  EXPECT_TRUE(std::ranges::is_sorted(levels));
  for (std::size_t i = 1; i < levels.size(); ++i) EXPECT_LT(levels[i] - levels[i - 1], 12);
  EXPECT_EQ(levels.back(), 200);
  const hal::Duration took = due - kStart;
  EXPECT_GT(took, 500ms);
  EXPECT_LE(took, FadeIn::kDuration);
}

TEST(FadeIn, ShowsFramesThatComeRarelyWholeFromTheSecondOn) {
  FadeIn fade;
  fade.begin(std::make_shared<hal::Image>(filled(40)));
  hal::Image frame = filled(200);
  EXPECT_FALSE(fade.apply(frame, kStart));
  frame = filled(200);
  EXPECT_TRUE(fade.apply(frame, kStart + 3s));
  EXPECT_EQ(levelOf(frame), 200);
}

TEST(FadeIn, EndsWithAFrameOfAnotherFormat) {
  FadeIn fade;
  fade.begin(std::make_shared<hal::Image>(filled(40, {8, 8})));
  hal::Image frame = filled(200);
  EXPECT_TRUE(fade.apply(frame, kStart));
  EXPECT_FALSE(fade.isOn());
  EXPECT_EQ(levelOf(frame), 200);
}

}  // namespace
}  // namespace pleinair::runtime
