#include "pipeline/calibration/coverage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/board_scene.h"

namespace pleinair::calibration {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

const Board kBoard(Checkerboard{9, 6, 0.025});
const tracking::CameraModel kCamera({600, 600, 320, 240}, {}, {640, 480});

ViewTraits traitsOfHold(const support::BoardHold& hold) {
  const auto pose = support::cameraFromBoard(kBoard, kCamera, hold);
  return traitsOf(kBoard, support::idealSighting(kBoard, kCamera, pose), kCamera.imageSize());
}

TEST(Coverage, KnowsWhichSideOfABoardIsNearer) {
  const auto has = [](const support::BoardHold& hold, Tilt tilt) {
    return traitsOfHold(hold).has(tilt);
  };
  EXPECT_TRUE(has({.yaw = 0.5}, Tilt::kLeftNearer));
  EXPECT_TRUE(has({.yaw = -0.5}, Tilt::kRightNearer));
  EXPECT_TRUE(has({.pitch = 0.5}, Tilt::kTopNearer));
  EXPECT_TRUE(has({.pitch = -0.5}, Tilt::kBottomNearer));
  // Also for boards rotated in their plane and off-centre.
  EXPECT_TRUE(has({.at = {0.7, 0.6}, .yaw = 0.5, .roll = 1.2}, Tilt::kLeftNearer));
  for (const Tilt tilt :
       {Tilt::kLeftNearer, Tilt::kRightNearer, Tilt::kTopNearer, Tilt::kBottomNearer}) {
    EXPECT_FALSE(has({}, tilt));
    EXPECT_FALSE(has({.at = {0.7, 0.7}}, tilt));
  }
}

TEST(Coverage, TheTestsTiltsAreWhatTheySay) {
  const auto depth = [](const support::BoardHold& hold, int corner) {
    const glm::dvec3& at = kBoard.corners()[static_cast<std::size_t>(corner)];
    return (support::cameraFromBoard(kBoard, kCamera, hold) * glm::dvec4(at, 1.0)).z;
  };
  EXPECT_LT(depth({.yaw = 0.5}, 0), depth({.yaw = 0.5}, 8));       // left, right
  EXPECT_LT(depth({.pitch = 0.5}, 0), depth({.pitch = 0.5}, 45));  // upper, lower
}

TEST(Coverage, WishesForWhatIsMissing) {
  Coverage coverage;
  EXPECT_THAT(*coverage.missingViews(), HasSubstr("left side is nearer"));
  for (int i = 0; i < 2; ++i) {
    coverage.add(traitsOfHold({.at = {0.4, 0.6}, .span = 0.62, .yaw = 0.4}));
    coverage.add(traitsOfHold({.at = {0.4, 0.6}, .span = 0.62, .yaw = -0.4}));
    coverage.add(traitsOfHold({.at = {0.4, 0.6}, .span = 0.62, .pitch = 0.4}));
  }
  EXPECT_THAT(*coverage.missingViews(), HasSubstr("lower side is nearer"));
  for (int i = 0; i < 2; ++i)
    coverage.add(traitsOfHold({.at = {0.4, 0.6}, .span = 0.62, .pitch = -0.4}));
  EXPECT_THAT(*coverage.missingViews(), HasSubstr("further away"));
  for (int i = 0; i < 3; ++i) coverage.add(traitsOfHold({.at = {0.2, 0.18}, .span = 0.3}));
  EXPECT_EQ(*coverage.missingViews(), "bring the board to the upper right corner");
  EXPECT_THAT(coverage.uncoveredRegions(), Not(Contains("the upper left corner")));
  EXPECT_THAT(coverage.uncoveredRegions(), Contains("the upper side"));
  EXPECT_FALSE(coverage.isComplete());
}

TEST(Coverage, IsCompleteAfterAGoodTour) {
  Coverage coverage;
  for (const auto& hold : support::calibrationPoses(kBoard, kCamera))
    coverage.add(traitsOfHold(hold));
  EXPECT_TRUE(coverage.isComplete()) << *coverage.missingViews();
  EXPECT_GT(coverage.coveredShare(), 0.9);
}

TEST(Coverage, GivesBackWhatIsRemoved) {
  const ViewTraits near = traitsOfHold({.span = 0.8, .yaw = 0.4});
  Coverage coverage;
  const double gain = coverage.gain(near);
  coverage.add(near);
  coverage.add(near);
  EXPECT_EQ(coverage.gain(near), 0.0);
  EXPECT_FALSE(coverage.isRedundant(near));
  coverage.add(near);
  EXPECT_TRUE(coverage.isRedundant(near));
  for (int i = 0; i < 3; ++i) coverage.remove(near);
  EXPECT_EQ(coverage.gain(near), gain);
  EXPECT_EQ(coverage.coveredShare(), 0.0);
}

}  // namespace
}  // namespace pleinair::calibration
