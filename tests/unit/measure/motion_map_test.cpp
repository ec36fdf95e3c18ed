#include "pipeline/measure/input/motion_map.h"

#include <cmath>

#include <gtest/gtest.h>

#include "pipeline/measure/input/dense_motion.h"
#include "pipeline/measure/input/picture.h"
#include "pipeline/measure/input/true_motion.h"
#include "tests/unit/measure/measure_pictures.h"

namespace pleinair::measure {
namespace {

const cv::Size kSize(200, 180);

cv::Mat1f quadratic() {
  cv::Mat1f picture(kSize);
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      picture(y, x) = 0.01F * static_cast<float>(x * x) - 0.02F * static_cast<float>(x * y) +
                      0.005F * static_cast<float>(y * y);
    }
  }
  return picture;
}

float quadraticAt(float x, float y) {
  return 0.01F * x * x - 0.02F * x * y + 0.005F * y * y;
}

TEST(MotionMap, IsAShiftWhereTheMotionIsWhole) {
  EXPECT_EQ(constantMap(kSize, {-3, -1}).shift, cv::Point(-3, -1));
  EXPECT_FALSE(constantMap(kSize, {-1.5, -0.5}).shift);
}

TEST(MotionMap, InterpolatesQuadraticsExactly) {
  const MotionMap map = constantMap(kSize, {2.3, -1.6});
  const Warped<cv::Mat1f> carried = warpedBack(quadratic(), map, {4, 2});
  int seen = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      if (carried.mask(y, x) == 0) continue;
      ++seen;
      ASSERT_NEAR(carried.picture(y, x),
                  quadraticAt(static_cast<float>(x) + 6.3F, static_cast<float>(y) + 0.4F), 2e-3);
    }
  }
  EXPECT_EQ(seen, (200 - 80) * (180 - 80));
}

TEST(MotionMap, LeavesOutWhatComesFromOutsideTheFrame) {
  const MotionMap map = constantMap(kSize, {100.0, 0});
  const Warped<cv::Mat1f> carried = warpedBack(quadratic(), map);
  EXPECT_NE(carried.mask(90, 99), 0);
  EXPECT_EQ(carried.mask(90, 100), 0);
}

TEST(MotionMap, LeavesOutMotionBoundariesAndWhatIsHidden) {
  cv::Mat2f field(kSize, cv::Vec2f(1, 0));
  field.colRange(100, kSize.width).setTo(cv::Vec2f(4, 0));
  cv::Mat1b seen(kSize, 255);
  seen(90, 60) = 0;
  const MotionMap map = fieldMap(field, seen, 0.5F);
  EXPECT_EQ(map.valid(50, 99), 0);
  EXPECT_EQ(map.valid(50, 96), 0);
  EXPECT_EQ(map.valid(50, 102), 0);
  EXPECT_NE(map.valid(50, 95), 0);
  EXPECT_NE(map.valid(50, 103), 0);
  EXPECT_EQ(map.valid(93, 63), 0);
  EXPECT_NE(map.valid(94, 64), 0);
  // With a filter radius of 12 px, 12 px more are invalid.
  const Warped<cv::Mat1f> wide = warpedBack(quadratic(), map, {}, 12);
  EXPECT_EQ(wide.mask(50, 84), 0);
  EXPECT_NE(wide.mask(50, 83), 0);
}

TEST(MotionMap, TellsTheDisplacementBetweenPixels) {
  cv::Mat2f field(kSize);
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      field(y, x) = {0.1F * static_cast<float>(x), 0.05F * static_cast<float>(y)};
    }
  }
  const MotionMap map = fieldMap(field, cv::Mat1b(kSize, 255), 0.5F);
  const auto at = displacementAt(map, {70.25F, 90.5F});
  ASSERT_TRUE(at);
  EXPECT_NEAR(at->x, 7.025, 1e-4);
  EXPECT_NEAR(at->y, 4.525, 1e-4);
  EXPECT_FALSE(displacementAt(map, {-1, 5}));
}

TEST(MotionMap, IsLimitedToARegionAwayFromBoundaries) {
  const MotionMap map = constantMap(kSize, {2.3, -1.6});
  cv::Mat1b region(kSize, 0);
  region(cv::Rect(60, 60, 30, 20)).setTo(255);
  EXPECT_EQ(cv::countNonZero(limitedTo(region, map).valid), 600);
  MotionMap hidden = map;
  hidden.valid(cv::Rect(60, 60, 1, 1)).setTo(0);
  EXPECT_EQ(cv::countNonZero(limitedTo(region, hidden, 4).valid), 600 - 25);
}

TEST(DenseMotion, FindsAShiftAndKnowsWhereThereIsNone) {
  cv::Mat3b canvas;
  strongBlobs({240, 220}, 5).convertTo(canvas, CV_8U, 255.0);
  const cv::Mat3b earlier = canvas(cv::Rect(cv::Point(10, 10), kSize)).clone();
  cv::Mat3b later = canvas(cv::Rect(cv::Point(7, 12), kSize)).clone();
  strongBlobs({60, 60}, 9).convertTo(later(cv::Rect(100, 80, 60, 60)), CV_8U, 255.0);
  const MotionMap map = denseMotion(earlier, later);
  int right = 0;
  int valid = 0;
  int wrong = 0;  // in the middle of what has been replaced
  for (int y = 40; y < 140; ++y) {
    for (int x = 40; x < 160; ++x) {
      if (map.valid(y, x) == 0) continue;
      const bool isReplaced = cv::Rect(108, 88, 44, 44).contains({x, y});
      wrong += isReplaced ? 1 : 0;
      if (cv::Rect(80, 60, 80, 80).contains({x, y})) continue;
      ++valid;
      right += cv::norm(map.displacement(y, x) - cv::Vec2f(3, -2)) < 0.3 ? 1 : 0;
    }
  }
  EXPECT_GT(valid, 4000);
  EXPECT_GT(right, 0.95 * valid);
  EXPECT_LT(wrong, 44 * 44 / 2);
}

TEST(KnownMotion, FollowsAHomographyOverAnyFrames) {
  const auto motion = homographyMotion(kSize, "zoom", [](std::uint64_t t) {
    const double s = std::pow(1.01, static_cast<double>(t));
    return cv::Matx33d(s, 0, 100 * (1 - s), 0, s, 90 * (1 - s), 0, 0, 1);
  });
  const hal::Result<MotionMap> map = motion->between(5, 15);
  ASSERT_TRUE(map);
  const float grown = static_cast<float>(std::pow(1.01, 10) - 1);
  EXPECT_NEAR(map->displacement(90, 160)[0], 60 * grown, 1e-4);
  EXPECT_NEAR(map->displacement(120, 100)[1], 30 * grown, 1e-4);
}

TEST(KnownMotion, AddsUpAConstantVector) {
  const auto motion = constantMotion(kSize, {-1.5, -0.5});
  EXPECT_EQ(motion->kind(), MotionKind::kPan);
  EXPECT_EQ(constantMotion(kSize, {0, 0})->kind(), MotionKind::kStill);
  EXPECT_EQ(motion->between(4, 6)->shift, cv::Point(-3, -1));
  EXPECT_FALSE(motion->between(4, 5)->shift);
  EXPECT_NEAR(motion->between(4, 5)->displacement(7, 7)[0], -1.5, 1e-6);
}

TEST(StandingMotion, BesideAMoverNothingMoves) {
  // A plain wall, beside which dense motion is the mover's.
  const cv::Rect before(80, 60, 70, 60);
  const cv::Rect after = before + cv::Point(6, -2);
  cv::Mat3b things;
  strongBlobs(before.size(), 9).convertTo(things, CV_8U, 255.0);
  const auto seenAt = [&](const cv::Rect& place) {
    cv::Mat3b picture(kSize, cv::Vec3b(120, 120, 120));
    things.copyTo(picture(place));
    return picture;
  };
  const auto maskOf = [](const cv::Rect& place) {
    cv::Mat1b mask(kSize, std::uint8_t{0});
    mask(place).setTo(255);
    return mask;
  };
  const cv::Mat3b earlier = seenAt(before);
  const cv::Mat3b later = seenAt(after);
  const MotionMap standing = standingMotion(earlier, later, maskOf(before), maskOf(after));
  const MotionMap dense = denseMotion(earlier, later);
  const cv::Rect left(before.x - 8, before.y + 10, 4, 40);  // where the mover is not in either
  int moving = 0;
  for (int y = left.y; y < left.br().y; ++y) {
    for (int x = left.x; x < left.br().x; ++x) {
      EXPECT_NE(standing.valid(y, x), 0) << x << " " << y;
      EXPECT_EQ(standing.displacement(y, x), cv::Vec2f());
      moving += cv::norm(dense.displacement(y, x)) > 0.5 ? 1 : 0;
    }
  }
  EXPECT_GT(moving, left.area() / 2) << "the control: there is something to be told";
  const cv::Point covered(after.br().x - 2, before.y + 30);
  EXPECT_EQ(standing.valid(covered), 0);
  int right = 0;
  const cv::Rect inside(before.x + 15, before.y + 15, 40, 30);
  for (int y = inside.y; y < inside.br().y; ++y) {
    for (int x = inside.x; x < inside.br().x; ++x) {
      right += cv::norm(standing.displacement(y, x) - cv::Vec2f(6, -2)) < 0.5 ? 1 : 0;
    }
  }
  EXPECT_GT(right, 9 * inside.area() / 10);
}

}  // namespace
}  // namespace pleinair::measure
