#include "pipeline/tracking/motion/motion_outliers.h"

#include <vector>

#include <gtest/gtest.h>

namespace pleinair::tracking {
namespace {

/// A grid of features whose right half moves differently from the left.
struct TwoHalves {
  std::vector<cv::Point2f> places;
  std::vector<cv::Point2f> steps;
  TwoHalves() {
    for (int y = 0; y < 10; ++y) {
      for (int x = 0; x < 10; ++x) {
        places.emplace_back(20.0F * static_cast<float>(x), 20.0F * static_cast<float>(y));
        steps.push_back(x < 5 ? cv::Point2f(3.0F, 0.0F) : cv::Point2f(-8.0F, 1.0F));
      }
    }
  }
};

TEST(MotionOutliers, ThingsMayMoveApart) {
  const TwoHalves all;
  MotionOutliers outliers;
  outliers.judge(all.places, all.steps);
  for (std::size_t i = 0; i < all.places.size(); ++i) EXPECT_FALSE(outliers.isOutlier(i)) << i;
}

TEST(MotionOutliers, OneThatMovesOtherwiseThanAllAroundIsOne) {
  TwoHalves all;
  all.steps[22] = {3.0F, 9.0F};
  all.steps[57] = {30.0F, 1.0F};
  MotionOutliers outliers;
  outliers.judge(all.places, all.steps);
  for (std::size_t i = 0; i < all.places.size(); ++i) {
    EXPECT_EQ(outliers.isOutlier(i), i == 22 || i == 57) << i;
  }
}

TEST(MotionOutliers, FewAreNotJudged) {
  const std::vector<cv::Point2f> places{{0, 0}, {10, 0}, {0, 10}};
  const std::vector<cv::Point2f> steps{{0, 0}, {50, 0}, {0, 50}};
  MotionOutliers outliers;
  outliers.judge(places, steps);
  for (std::size_t i = 0; i < places.size(); ++i) EXPECT_FALSE(outliers.isOutlier(i));
}

}  // namespace
}  // namespace pleinair::tracking
