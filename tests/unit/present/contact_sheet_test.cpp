#include "pipeline/present/contact_sheet.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace pleinair::present {
namespace {

using std::chrono_literals::operator""ms;

hal::Image grey(std::uint8_t level, hal::FrameSize size) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = size});
  std::ranges::fill(image.plane(0), level);
  return image;
}

/// Plays `frames` frames whose originals hold their index as a grey level, and returns the levels
/// in the middle of the sheet's original tiles, in reading order.
std::vector<int> originalsOf(int frames, int moments, hal::FrameSize size) {
  ContactSheet sheet(moments);
  for (int i = 0; i < frames; ++i) {
    if (!sheet.wants(static_cast<std::size_t>(i))) continue;
    sheet.add(grey(static_cast<std::uint8_t>(i), size).view(), grey(255, size).view(), i * 10ms);
  }
  hal::Image image = sheet.sheet();
  std::vector<int> levels;
  for (int pair = 0; pair < std::min(frames, moments); ++pair) {
    const int x = 6 + (pair % 2) * 2 * (size.width + 6) + size.width / 2;
    const int y = 6 + (pair / 2) * (size.height + 6) + size.height / 2;
    levels.push_back(image.row(0, y)[static_cast<std::size_t>(x) * 3]);
  }
  return levels;
}

TEST(ContactSheet, SpreadsItsMomentsOverAMovieOfUnknownLength) {
  for (const int frames : {1, 2, 5, 6, 7, 11, 12, 13, 40, 97, 200}) {
    const std::vector<int> levels = originalsOf(frames, 6, {20, 10});
    EXPECT_EQ(levels.front(), 0);
    EXPECT_EQ(std::set<int>(levels.begin(), levels.end()).size(), levels.size()) << frames;
    // The last moment is near the end, though the end was not known.
    EXPECT_GE(levels.back(), (frames - 1) * 85 / 100) << frames;
    EXPECT_TRUE(std::ranges::is_sorted(levels)) << frames;
  }
}

TEST(ContactSheet, TakesPicturesOfOnePixelAndVeryTallOnes) {
  EXPECT_EQ(originalsOf(3, 6, {1, 1}), (std::vector<int>{0, 1, 2}));
  ContactSheet tall(1);
  tall.add(grey(1, {8, 4000}).view(), grey(2, {8, 4000}).view(), 0ms);
  EXPECT_LE(tall.sheet().size().height, 1000);
}

}  // namespace
}  // namespace pleinair::present
