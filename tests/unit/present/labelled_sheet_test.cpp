#include "pipeline/present/labelled_sheet.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace pleinair::present {
namespace {

constexpr hal::FrameSize kTile{60, 40};

LabelledImage tileOf(std::uint8_t grey, std::string label) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = kTile});
  std::ranges::fill(image.plane(0), grey);
  return {std::move(image), std::move(label)};
}

TEST(LabelledSheet, ShowsImagesInReadingOrderWithTheirLabels) {
  std::vector<LabelledImage> tiles;
  for (int i = 0; i < 3; ++i) tiles.push_back(tileOf(static_cast<std::uint8_t>(50 * i), "label"));
  hal::Image sheet = labelledSheet(tiles, 2);
  EXPECT_EQ(sheet.size(), (hal::FrameSize{12 + 2 * 72, 12 + 2 * 76}));
  const auto grey = [&](int x, int y) {
    return static_cast<int>(sheet.row(0, y)[3 * static_cast<std::size_t>(x)]);
  };
  EXPECT_EQ(grey(20, 20), 0);
  EXPECT_EQ(grey(20 + 72, 20), 50);
  EXPECT_EQ(grey(20, 20 + 76), 100);
  EXPECT_EQ(grey(20 + 72, 20 + 76), 255) << "there is no fourth";
  int ink = 0;
  for (int y = 54; y < 76; ++y) {
    for (int x = 12; x < 72; ++x) ink += grey(x, y) < 128 ? 1 : 0;
  }
  EXPECT_GT(ink, 10) << "a label is below its image";
}

TEST(LabelledSheet, CutsLabelsThatAreWiderThanTheImage) {
  const std::vector<LabelledImage> tiles{tileOf(10, "a label that is far wider than its image"),
                                         tileOf(20, "")};
  hal::Image sheet = labelledSheet(tiles, 2);
  for (int y = 54; y < 76; ++y) {
    EXPECT_EQ(sheet.row(0, y)[3 * std::size_t{78}], 255) << "between the columns";
  }
}

}  // namespace
}  // namespace pleinair::present
