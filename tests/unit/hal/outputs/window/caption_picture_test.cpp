#include <algorithm>

#include <gtest/gtest.h>

#include "hal/outputs/window/caption.h"

namespace pleinair::hal::window {
namespace {

int inkIn(Image& image, int fromX, int toX) {
  int inked = 0;
  for (int y = 0; y < image.size().height; ++y) {
    const auto row = image.row(0, y);
    for (int x = fromX; x < std::min(toX, image.size().width); ++x) {
      inked += row[static_cast<std::size_t>(x)] > 127 ? 1 : 0;
    }
  }
  return inked;
}

TEST(CaptionPicture, HoldsTheTextInItsSize) {
  Image line = captionPicture("cell_size 8 px", 15, 1000);
  EXPECT_EQ(line.format().pixelFormat, PixelFormat::kGrey8);
  EXPECT_GT(line.size().width, 60);
  EXPECT_LT(line.size().width, 200);
  EXPECT_GT(inkIn(line, 0, 1000), 100);
  const Image large = captionPicture("cell_size 8 px", 30, 1000);
  EXPECT_NEAR(large.size().width, 2 * line.size().width, 12);
  EXPECT_NEAR(large.size().height, 2 * line.size().height, 4);
}

TEST(CaptionPicture, PutsLinesUnderEachOther) {
  const Image one = captionPicture("saved", 15, 1000);
  const Image three = captionPicture("saved\nsaved\nsaved", 15, 1000);
  EXPECT_EQ(three.size().width, one.size().width);
  EXPECT_NEAR(three.size().height, 3 * one.size().height, 2);
}

TEST(CaptionPicture, HasASecondColumn) {
  Image picture = captionPicture("q\tquit\nEscape\tquit", 15, 1000);
  const int column = 10 * 15;
  EXPECT_EQ(inkIn(picture, column - 30, column), 0);
  EXPECT_GT(inkIn(picture, column, column + 40), 20);
}

TEST(CaptionPicture, CutsWhatIsTooWide) {
  const std::string text = "a line that is much longer than there is room for";
  Image cut = captionPicture(text, 15, 120);
  EXPECT_LE(cut.size().width, 120);
  EXPECT_EQ(cut.size().height, captionPicture(text, 15, 1000).size().height);
  EXPECT_GT(inkIn(cut, 0, 120), 50);
}

TEST(CaptionPicture, SurvivesAnyText) {
  for (const std::string text : {"", "\n", "\t", "\xff\xfe", "·…°"}) {
    EXPECT_TRUE(isAcceptedSize(captionPicture(text, 15, 100).size()));
  }
}

}  // namespace
}  // namespace pleinair::hal::window
