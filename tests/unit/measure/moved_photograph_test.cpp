#include "pipeline/measure/input/moved_photograph.h"

#include <gtest/gtest.h>

#include "pipeline/measure/image_measures.h"
#include "pipeline/measure/input/picture.h"
#include "tests/unit/measure/measure_pictures.h"

namespace pleinair::measure {
namespace {

constexpr hal::FrameSize kFrame{240, 200};

hal::Image photograph(cv::Size size) {
  return toImage(blobPicture(size, 1));
}

TEST(MovedPhotograph, PansToTheBitWhereTheWayIsWhole) {
  const MovedPhotograph moved(photograph({500, 400}), kFrame, {.pan = {-1.5, -0.5}}, 20);
  const auto motion = moved.motion();
  EXPECT_EQ(motion->kind(), MotionKind::kPan);
  const hal::Result<MotionMap> map = motion->between(3, 5);
  const Mean error = warpingError(moved.frame(3), warpedBack(moved.frame(5), *map));
  EXPECT_LT(*error.value(), 1e-11);
  EXPECT_FALSE(moved.isMirrored());
}

void expectFollows(const PhotographMotion& how) {
  const MovedPhotograph moved(photograph({500, 400}), kFrame, how, 20);
  const auto motion = moved.motion();
  const cv::Mat3f earlier = moved.frame(2);
  const cv::Mat3f later = moved.frame(12);
  const Mean along = warpingError(earlier, warpedBack(later, *motion->between(2, 12)));
  const Mean standing = warpingError(earlier, warpedBack(later, constantMap({240, 200}, {0, 0})));
  EXPECT_LT(*along.value(), 2e-5) << "along the motion";
  EXPECT_GT(*standing.value(), 100 * *along.value());
}

TEST(MovedPhotograph, ZoomsAsItsMotionSays) {
  expectFollows({.zoomPercent = 1});
}

TEST(MovedPhotograph, RollsAsItsMotionSays) {
  expectFollows({.rollDegrees = 1});
}

TEST(MovedPhotograph, DoesAllAtOnce) {
  expectFollows({.pan = {0.7, -0.4}, .zoomPercent = -0.5, .rollDegrees = -0.5});
}

TEST(MovedPhotograph, GoesOnMirroredBeyondItsEdges) {
  const MovedPhotograph moved(photograph({200, 160}), kFrame, {.pan = {2, 0}}, 40);
  EXPECT_TRUE(moved.isMirrored());
  const Mean error =
      warpingError(moved.frame(0), warpedBack(moved.frame(30), *moved.motion()->between(0, 30)));
  EXPECT_LT(*error.value(), 1e-11);
}

TEST(MovedPhotograph, IsScaledDownToFillTheFrames) {
  // Four times too large: stripes of 32 px become stripes of 8.
  cv::Mat3f stripes(880, 1040);
  for (int y = 0; y < stripes.rows; ++y) {
    for (int x = 0; x < stripes.cols; ++x) {
      stripes(y, x) = cv::Vec3f::all(x / 16 % 2 == 0 ? 0.2F : 0.8F);
    }
  }
  const MovedPhotograph moved(toImage(stripes), {260, 220}, {}, 1);
  const cv::Mat3f frame = moved.frame(0);
  int edges = 0;
  for (int x = 0; x + 1 < frame.cols; ++x) {
    edges += (frame(110, x)[0] < 0.5F) != (frame(110, x + 1)[0] < 0.5F) ? 1 : 0;
  }
  EXPECT_NEAR(edges, 260 / 4, 1);
}

}  // namespace
}  // namespace pleinair::measure
