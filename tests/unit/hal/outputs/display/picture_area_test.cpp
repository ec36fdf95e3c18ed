#include "hal/outputs/display/picture_area.h"

#include <gtest/gtest.h>

namespace pleinair::hal::display {
namespace {

using Fit = Placement::Fit;

TEST(PictureArea, IsAsLargeAsFitsBetweenBars) {
  EXPECT_EQ(areaOf({640, 480}, {1920, 1080}, {}), (PictureArea{240, 0, {1440, 1080}}));
  EXPECT_EQ(areaOf({1280, 720}, {1024, 768}, {}), (PictureArea{0, 96, {1024, 576}}));
  EXPECT_EQ(areaOf({640, 480}, {640, 480}, {}), (PictureArea{0, 0, {640, 480}}));
}

TEST(PictureArea, FillsTheDisplayIfAskedTo) {
  EXPECT_EQ(areaOf({640, 480}, {1920, 1080}, {.fit = Fit::kFill}),
            (PictureArea{0, 0, {1920, 1080}}));
}

TEST(PictureArea, OfATurnedPictureIsUpright) {
  EXPECT_EQ(areaOf({640, 480}, {1920, 1080}, {.quarterTurns = 1}),
            (PictureArea{555, 0, {810, 1080}}));
  EXPECT_EQ(areaOf({640, 480}, {1920, 1080}, {.quarterTurns = 2}),
            (PictureArea{240, 0, {1440, 1080}}));
}

TEST(PictureArea, LeavesTheMarginBlack) {
  EXPECT_EQ(areaOf({16, 9}, {1600, 900}, {.marginPercent = 5.0}),
            (PictureArea{80, 45, {1440, 810}}));
  EXPECT_EQ(areaOf({1, 1}, {1600, 900}, {.fit = Fit::kFill, .marginPercent = 5.0}),
            (PictureArea{80, 45, {1440, 810}}));
}

TEST(PictureArea, HasAPixelAtLeast) {
  EXPECT_EQ(areaOf({8192, 1}, {16, 16}, {}).size, (FrameSize{16, 1}));
}

}  // namespace
}  // namespace pleinair::hal::display
