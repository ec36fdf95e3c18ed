#include "pipeline/measure/lasting_marks.h"

#include <gtest/gtest.h>

#include "pipeline/measure/input/picture.h"
#include "tests/unit/measure/measure_pictures.h"

namespace pleinair::measure {
namespace {

const cv::Size kSize(320, 240);
const cv::Point kShift(-15, -5);

Mean lasting(const cv::Mat3f& earlier, const cv::Mat3f& later, cv::Point shift = kShift) {
  return lastingMarks(greyOf(earlier),
                      warpedBack(greyOf(later), constantMap(kSize, cv::Point2d(shift))));
}

TEST(LastingMarks, AreAllOfAPatternThatIsCarried) {
  const cv::Mat3f canvas = blobPicture({360, 280}, 1);
  const cv::Mat3f earlier = windowOf(canvas, {20, 20}, kSize);
  const Mean found = lasting(earlier, windowOf(canvas, cv::Point(20, 20) - kShift, kSize));
  EXPECT_GT(found.weight, 100);
  EXPECT_EQ(found.value(), 1.0);
  // A mark one px away is still found; one four px away is not.
  EXPECT_EQ(*lasting(earlier, windowOf(canvas, cv::Point(21, 20) - kShift, kSize)).value(), 1.0);
  EXPECT_LT(*lasting(earlier, windowOf(canvas, cv::Point(24, 20) - kShift, kSize)).value(), 0.1);
}

TEST(LastingMarks, AreNoneOfStrangers) {
  const Mean found = lasting(blobPicture(kSize, 2), blobPicture(kSize, 3));
  EXPECT_GT(found.weight, 100);
  EXPECT_LT(*found.value(), 0.02);
}

TEST(LastingMarks, AreNotToldOfAFlatPicture) {
  const cv::Mat3f flat(kSize, cv::Vec3f(0.5F, 0.5F, 0.5F));
  EXPECT_FALSE(lasting(flat, flat).value());
}

TEST(LastingMarks, AreThreeHundredAtTheMost) {
  const cv::Mat3f wide = noisePicture({900, 700}, 0.2, 4);
  const Mean found =
      lastingMarks(greyOf(wide), warpedBack(greyOf(wide), constantMap(wide.size(), {0, 0})));
  EXPECT_EQ(found.weight, 300);
}

}  // namespace
}  // namespace pleinair::measure
