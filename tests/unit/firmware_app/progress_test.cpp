#include "firmware_app/cli/progress.h"

#include <gtest/gtest.h>

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;

TEST(ProgressLine, SaysRateAndTimeLeft) {
  EXPECT_EQ(progressLine("painting", 37, 150, 2s), "painting 37/150  18.5 frames/s  6 s left");
  EXPECT_EQ(progressLine("painting", 150, 150, 3s), "painting 150/150  50.0 frames/s  0 s left");
}

TEST(ProgressLine, DoesWithoutATotal) {
  EXPECT_EQ(progressLine("recording", 5, std::nullopt, 2s), "recording frame 5  2.5 frames/s");
}

TEST(ProgressLine, GuessesNoTimeBeforeTheFirstFrame) {
  EXPECT_EQ(progressLine("painting", 0, 150, 0s), "painting 0/150  0.0 frames/s");
  EXPECT_EQ(progressLine("painting", 0, 150, 9s), "painting 0/150  0.0 frames/s");
}

TEST(ProgressLine, CopesWithMoreFramesThanWereSaid) {
  EXPECT_EQ(progressLine("painting", 12, 10, 1s), "painting 12/10  12.0 frames/s  0 s left");
}

TEST(Progress, MeasuresByItsClock) {
  hal::SteppedClock clock;
  Progress progress("painting", 3, clock);
  EXPECT_EQ(progress.framesPerSecond(), 0.0);
  progress.advance();
  progress.advance();
  clock.advance(4s);
  EXPECT_EQ(progress.frames(), 2u);
  EXPECT_EQ(progress.elapsed(), 4s);
  EXPECT_EQ(progress.framesPerSecond(), 0.5);
}

}  // namespace
}  // namespace pleinair::app
