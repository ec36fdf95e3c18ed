#include "hal/outputs/window/window_layout.h"

#include <cstdlib>

#include <gtest/gtest.h>

namespace pleinair::hal::window {

void PrintTo(const Area& area, std::ostream* out);
void PrintTo(const Area& area, std::ostream* out) {
  *out << area.size.width << "x" << area.size.height << "+" << area.x << "+" << area.y;
}

namespace {

TEST(LetterBox, FillsAWindowOfThePicturesShape) {
  EXPECT_EQ(letterBox({640, 480}, {640, 480}), (Area{0, 0, {640, 480}}));
  EXPECT_EQ(letterBox({640, 480}, {320, 240}), (Area{0, 0, {320, 240}}));
  EXPECT_EQ(letterBox({640, 480}, {1280, 960}), (Area{0, 0, {1280, 960}}));
}

TEST(LetterBox, LeavesBarsOnTwoSidesOfOthers) {
  EXPECT_EQ(letterBox({640, 480}, {1280, 480}), (Area{320, 0, {640, 480}}));
  EXPECT_EQ(letterBox({640, 480}, {640, 1000}), (Area{0, 260, {640, 480}}));
  EXPECT_EQ(letterBox({1920, 1080}, {1024, 768}), (Area{0, 96, {1024, 576}}));
}

TEST(LetterBox, OfATurnedPictureFitsTheWindowAfterTheTurn) {
  EXPECT_EQ(turnedLetterBox({640, 480}, {1280, 480}, 0), letterBox({640, 480}, {1280, 480}));
  EXPECT_EQ(turnedLetterBox({640, 480}, {1280, 480}, 2), letterBox({640, 480}, {1280, 480}));
  // Turned, it is seen as 360x480 at 460,0: the same centre, sides exchanged.
  EXPECT_EQ(turnedLetterBox({640, 480}, {1280, 480}, 1), (Area{400, 60, {480, 360}}));
  EXPECT_EQ(turnedLetterBox({640, 480}, {480, 640}, 3), (Area{-80, 80, {640, 480}}));
}

TEST(LetterBox, KeepsShapeAndCentreForEverySize) {
  for (const FrameSize picture : {FrameSize{1, 1}, {640, 480}, {33, 17}, {8192, 1}, {1, 8192}}) {
    for (int width = 1; width < 900; width += 37) {
      for (int height = 1; height < 900; height += 41) {
        const Area area = letterBox(picture, {width, height});
        SCOPED_TRACE(testing::PrintToString(area));
        ASSERT_TRUE(area.size.width == width || area.size.height == height);
        ASSERT_GE(area.x, 0);
        ASSERT_GE(area.y, 0);
        ASSERT_LE(std::abs(width - area.size.width - 2 * area.x), 1);
        ASSERT_LE(std::abs(height - area.size.height - 2 * area.y), 1);
        // The other side follows from the aspect ratio, to half a pixel, or is one pixel.
        const bool isWide = picture.width * height > picture.height * width;
        const double wanted = isWide ? static_cast<double>(width) * picture.height / picture.width
                                     : static_cast<double>(height) * picture.width / picture.height;
        const int other = isWide ? area.size.height : area.size.width;
        ASSERT_TRUE(other == 1 || std::abs(other - wanted) <= 0.5);
      }
    }
  }
}

TEST(OpeningSize, IsThePicturesWhereItFits) {
  EXPECT_EQ(openingSize({640, 480}, {1920, 1080}), (FrameSize{640, 480}));
  EXPECT_EQ(openingSize({1920, 1080}, {1920, 1080}), (FrameSize{1920, 1080}));
}

TEST(OpeningSize, FitsLargePicturesIntoTheRoom) {
  EXPECT_EQ(openingSize({3840, 2160}, {1920, 1080}), (FrameSize{1920, 1080}));
  EXPECT_EQ(openingSize({3840, 2160}, {1024, 768}), (FrameSize{1024, 576}));
  EXPECT_EQ(openingSize({1080, 1920}, {1920, 1080}), (FrameSize{608, 1080}));
}

TEST(OpeningSize, EnlargesTinyPicturesByWholeFactors) {
  EXPECT_EQ(openingSize({64, 48}, {1024, 768}), (FrameSize{192, 144}));
  EXPECT_EQ(openingSize({1, 1}, {1024, 768}), (FrameSize{240, 240}));
  EXPECT_EQ(openingSize({121, 10}, {1024, 768}), (FrameSize{121, 10}));
  EXPECT_EQ(openingSize({64, 48}, {100, 100}), (FrameSize{100, 75}));
}

}  // namespace
}  // namespace pleinair::hal::window
