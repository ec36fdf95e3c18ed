#include "pipeline/present/waiting_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

namespace pleinair::present {
namespace {

constexpr hal::FrameSize kSize{640, 480};
const WaitingText kText{.title = "Waiting for the camera", .detail = "v4l2:/dev/video0"};

hal::Image filled(hal::FrameSize size, int red, int green, int blue) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = size, .encoding = {}});
  const std::array<int, 3> colour{red, green, blue};
  for (int y = 0; y < size.height; ++y) {
    const auto row = image.row(0, y);
    for (std::size_t i = 0; i < row.size(); ++i) {
      row[i] = static_cast<std::uint8_t>(colour[i % 3]);
    }
  }
  return image;
}

struct Box {
  double left, top, right, bottom;  // parts of the sides
};

/// Mean of a channel within a box.
double mean(const hal::Image& picture, Box box, std::size_t channel) {
  const hal::FrameSize size = picture.size();
  const hal::ImageView view = picture.view();
  double sum = 0.0;
  int count = 0;
  for (int y = static_cast<int>(box.top * size.height); y < box.bottom * size.height; ++y) {
    for (int x = static_cast<int>(box.left * size.width); x < box.right * size.width; ++x) {
      sum += view.row(0, y)[static_cast<std::size_t>(x) * 4 + channel];
      ++count;
    }
  }
  return sum / count;
}

/// Dark pixels in the margin that holds the text.
int inkOf(const hal::Image& picture) {
  const hal::FrameSize size = picture.size();
  const hal::ImageView view = picture.view();
  int ink = 0;
  for (int y = size.height * 82 / 100; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      ink += view.row(0, y)[static_cast<std::size_t>(x) * 4] < 170 ? 1 : 0;
    }
  }
  return ink;
}

TEST(WaitingPicture, IsOpaqueAndOfTheSizeThatIsAsked) {
  for (const hal::FrameSize size :
       {kSize, {1, 1}, {8, 6}, {64, 48}, {480, 800}, {1921, 1079}, {3000, 20}}) {
    const hal::Image picture = waitingPicture(size, {}, kText);
    ASSERT_EQ(picture.size(), size);
    ASSERT_EQ(picture.format().pixelFormat, hal::PixelFormat::kRgba8);
    EXPECT_EQ(mean(picture, {0, 0, 1, 1}, 3), 255.0);
  }
}

TEST(WaitingPicture, IsNeverDarkAndItsMarginIsPaper) {
  const hal::Image picture = waitingPicture(kSize, {}, {});
  for (const std::size_t channel : {0U, 1U, 2U}) {
    EXPECT_GT(mean(picture, {0, 0, 1, 1}, channel), 150.0);
    EXPECT_GT(mean(picture, {0.1, 0.85, 0.9, 1.0}, channel), 220.0);
  }
  EXPECT_EQ(inkOf(picture), 0);
}

TEST(WaitingPicture, SaysWhatItIsTold) {
  const hal::Image plain = waitingPicture(kSize, {}, {});
  const hal::Image title = waitingPicture(kSize, {}, {.title = kText.title, .detail = {}});
  const hal::Image both = waitingPicture(kSize, {}, kText);
  EXPECT_EQ(inkOf(plain), 0) << "a control";
  EXPECT_GT(inkOf(title), 500);
  EXPECT_GT(inkOf(both), inkOf(title) + 100);
  EXPECT_LT(inkOf(both), kSize.width * kSize.height / 40);
}

TEST(WaitingPicture, ShowsThePaintingWashedOutAtItsPlace) {
  hal::Image painting = filled({320, 240}, 20, 60, 200);
  for (int y = 0; y < 240; ++y) {  // the left half is red
    const auto row = painting.row(0, y);
    for (std::size_t x = 0; x < 160; ++x) {
      row[3 * x] = 200;
      row[3 * x + 2] = 20;
    }
  }
  const hal::Image picture = waitingPicture(kSize, painting.view(), kText);
  const Box left{0.2, 0.3, 0.45, 0.6};
  const Box right{0.55, 0.3, 0.8, 0.6};
  EXPECT_GT(mean(picture, left, 0), mean(picture, left, 2) + 40);
  EXPECT_GT(mean(picture, right, 2), mean(picture, right, 0) + 40);
  EXPECT_GT(mean(picture, right, 0), 60.0) << "lighter than the painting";
  EXPECT_GT(mean(picture, {0, 0, 1, 0.005}, 0), 220.0) << "paper at the edge";
}

TEST(WaitingPicture, IsTheSameForTheSameArguments) {
  const hal::Image painting = filled({100, 100}, 100, 120, 90);
  const hal::Image one = waitingPicture(kSize, painting.view(), kText);
  const hal::Image two = waitingPicture(kSize, painting.view(), kText);
  const hal::Image other = waitingPicture(kSize, painting.view(), {.title = "Else", .detail = {}});
  EXPECT_TRUE(std::ranges::equal(one.view().planes[0].bytes, two.view().planes[0].bytes));
  EXPECT_FALSE(std::ranges::equal(one.view().planes[0].bytes, other.view().planes[0].bytes));
}

TEST(WaitingPicture, WrapsALongLine) {
  const std::string sentence =
      "v4l2:usb-046d_HD_Pro_Webcam_C920_A1B2C3D4-video-index0: is used by another program that "
      "does not let go of it";
  const hal::Image picture = waitingPicture({320, 480}, {}, {.title = sentence, .detail = {}});
  EXPECT_GT(inkOf(picture), 500);
}

TEST(Turned, TurnsClockwiseByRightAngles) {
  hal::Image picture({.pixelFormat = hal::PixelFormat::kRgba8, .size = {3, 2}, .encoding = {}});
  picture.row(0, 0)[0] = 9;  // the upper left corner
  const hal::Image quarter = turned(picture, 1);
  ASSERT_EQ(quarter.size(), (hal::FrameSize{2, 3}));
  EXPECT_EQ(quarter.view().row(0, 0)[4], 9) << "the upper right one";
  EXPECT_EQ(turned(picture, 2).view().row(0, 1)[8], 9);
  EXPECT_EQ(turned(picture, 3).view().row(0, 2)[0], 9);
  EXPECT_EQ(turned(picture, -1).view().row(0, 2)[0], 9);
  EXPECT_EQ(turned(turned(picture, 1), -1).view().row(0, 0)[0], 9);
  EXPECT_EQ(mirrored(picture).view().row(0, 0)[8], 9);
  EXPECT_EQ(mirrored(picture).size(), picture.size());
}

TEST(WaitingPictures, AreThoseDrawnOneByOne) {
  WaitingPictures pictures;
  const hal::Image red = filled({320, 200}, 200, 30, 40);
  const hal::Image blue = filled({200, 320}, 20, 30, 200);
  const WaitingText other{.title = "Preparing to paint", .detail = ""};
  struct Step {
    hal::FrameSize size;
    const hal::Image* painting;
    std::uint64_t number;
    const WaitingText* text;
  };
  const std::array<Step, 7> steps{Step{kSize, nullptr, 0, &kText}, {kSize, nullptr, 0, &other},
                                  {kSize, &red, 1, &other},        {kSize, &red, 1, &kText},
                                  {kSize, &blue, 2, &kText},       {{300, 500}, &blue, 2, &kText},
                                  {kSize, nullptr, 0, &kText}};
  for (const Step& each : steps) {
    const hal::ImageView painting =
        each.painting != nullptr ? each.painting->view() : hal::ImageView();
    const hal::Image drawn = pictures.draw(each.size, painting, each.number, *each.text);
    const hal::Image expected = waitingPicture(each.size, painting, *each.text);
    ASSERT_EQ(drawn.format(), expected.format());
    EXPECT_TRUE(std::ranges::equal(drawn.view().planes[0].bytes, expected.view().planes[0].bytes))
        << &each - steps.data();
  }
}

}  // namespace
}  // namespace pleinair::present
