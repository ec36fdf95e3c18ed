#include "pipeline/present/caption_picture.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace pleinair::present {
namespace {

struct CaptionInk {
  int light = 0;  ///< pixels of letters
  int dark = 0;   ///< of the bare band
};

CaptionInk captionInkOf(const hal::Image& image) {
  CaptionInk ink;
  const hal::ImageView view = image.view();
  for (int y = 0; y < image.size().height; ++y) {
    const auto row = view.row(0, y);
    for (std::size_t i = 0; i < row.size(); i += 4) {
      if (row[i] > 200 && row[i + 3] > 200) ++ink.light;
      if (row[i] == 0 && row[i + 3] > 100 && row[i + 3] < 220) ++ink.dark;
    }
  }
  return ink;
}

bool isWithin(const CaptionPicture& caption, hal::FrameSize size) {
  return caption.left > 0 && caption.top > 0 &&
         caption.left + caption.image.size().width < size.width &&
         caption.top + caption.image.size().height < size.height;
}

TEST(CaptionPicture, IsTextOnADarkBandInTheUpperLeftCorner) {
  constexpr hal::FrameSize kSize{1920, 1080};
  const CaptionPicture caption = captionPicture("size 9 px\nbrush · 24 frames/s", kSize);
  ASSERT_TRUE(isWithin(caption, kSize));
  EXPECT_LT(caption.left, 40);
  EXPECT_LT(caption.top, 40);
  const CaptionInk ink = captionInkOf(caption.image);
  EXPECT_GT(ink.light, 500);
  EXPECT_GT(ink.dark, 5 * ink.light);
}

TEST(CaptionPicture, GrowsWithThePicture) {
  const auto heightOf = [](hal::FrameSize size) {
    return captionPicture("one line", size).image.size().height;
  };
  EXPECT_GT(heightOf({3840, 2160}), 2 * heightOf({1280, 720}));
  EXPECT_EQ(heightOf({1080, 1920}), heightOf({1920, 1080})) << "a screen that stands upright";
}

TEST(CaptionPicture, WrapsLongLines) {
  constexpr hal::FrameSize kSize{640, 480};
  const CaptionPicture shortOne = captionPicture("a word", kSize);
  std::string words;
  for (int i = 0; i < 60; ++i) words += "a word ";
  const CaptionPicture longOne = captionPicture(words, kSize);
  ASSERT_TRUE(isWithin(longOne, kSize));
  EXPECT_GT(longOne.image.size().height, 2 * shortOne.image.size().height);
}

TEST(CaptionPicture, HasSmallerLettersRatherThanFewerLines) {
  constexpr hal::FrameSize kSize{1920, 1080};
  std::string lines = "0";
  for (int i = 1; i < 45; ++i) lines += "\n" + std::to_string(i);
  const CaptionPicture many = captionPicture(lines, kSize);
  ASSERT_TRUE(isWithin(many, kSize));
  // The last line is there: some ink in the last twentieth of the band.
  const hal::ImageView view = many.image.view();
  int ink = 0;
  for (int y = many.image.size().height * 19 / 20; y < many.image.size().height; ++y) {
    const auto row = view.row(0, y);
    for (std::size_t i = 0; i < row.size(); i += 4) ink += row[i] > 200 ? 1 : 0;
  }
  EXPECT_GT(ink, 10);
}

TEST(CaptionPicture, IsNothingWhereThereIsNoRoomOrNoText) {
  EXPECT_EQ(captionPicture("text", {20, 20}).image.size().width, 0);
  EXPECT_EQ(captionPicture("", {640, 480}).image.size().width, 0);
}

}  // namespace
}  // namespace pleinair::present
