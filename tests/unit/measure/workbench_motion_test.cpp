#include "pipeline/measure/input/workbench_motion.h"

#include <gtest/gtest.h>

#include "pipeline/measure/input/picture.h"

namespace pleinair::measure {
namespace {

TEST(WorkbenchMotion, IsTheCamerasOwnFlow) {
  const hal::SyntheticOptions options{.size = {320, 240}};
  hal::SteppedClock clock;
  const hal::SyntheticCamera camera(options, clock);
  const hal::FlowField truth = camera.flowField(10, 12);
  const hal::Result<MotionMap> map = workbenchMotion(options)->between(10, 12);
  ASSERT_TRUE(map);
  int valid = 0;
  int hidden = 0;
  int wrong = 0;  // pixels on objects thinner than two pixels that move almost alike
  const cv::Rect inner = innerRect({320, 240});
  for (int y = inner.y; y < inner.br().y; ++y) {
    for (int x = inner.x; x < inner.br().x; ++x) {
      const auto i = static_cast<std::size_t>(y * 320 + x);
      if (truth.visible[i] == 0) {
        ++hidden;
        wrong += map->valid(y, x) != 0 ? 1 : 0;
        continue;
      }
      if (map->valid(y, x) == 0) continue;
      ++valid;
      const cv::Vec2f expected(truth.px[i].x, truth.px[i].y);
      wrong += cv::norm(map->displacement(y, x) - expected) > 0.1 ? 1 : 0;
    }
  }
  EXPECT_GT(valid, inner.area() / 2);
  EXPECT_LT(wrong, valid / 500);
  EXPECT_GT(hidden, 0);
}

TEST(WorkbenchMotion, LeavesOutTheEdgesOfWhatMovesBeforeTheBench) {
  const hal::SyntheticOptions options{.size = {320, 240}, .shot = hal::SyntheticShot::kOccluder};
  const hal::Result<MotionMap> map = workbenchMotion(options)->between(62, 66);
  ASSERT_TRUE(map);
  for (int y = 1; y < 240; ++y) {
    for (int x = 1; x < 320; ++x) {
      if (map->valid(y, x) == 0 || map->valid(y, x - 1) == 0) continue;
      ASSERT_LE(cv::norm(map->displacement(y, x) - map->displacement(y, x - 1)), 0.3);
    }
  }
}

TEST(WorkbenchMovers, AreTheArmWhileItIsThereAndAtRest) {
  const hal::SyntheticOptions options{.size = {160, 120}, .shot = hal::SyntheticShot::kHand};
  const std::unique_ptr<TrueMovers> movers = workbenchMovers(options);
  EXPECT_EQ(cv::countNonZero(movers->mask(0)), 0);
  const cv::Mat1b resting = movers->mask(110);
  ASSERT_EQ(resting.size(), cv::Size(160, 120));
  EXPECT_GT(cv::countNonZero(resting), 400);
  EXPECT_EQ(cv::countNonZero(resting), cv::countNonZero(movers->mask(111)));
}

}  // namespace
}  // namespace pleinair::measure
