#include "firmware_app/live/frame_counts.h"

#include <gtest/gtest.h>

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;

TEST(FrameCounts, AddUp) {
  FrameCounts counts;
  EXPECT_EQ(counts.captured(), 0u);
  for (int i = 0; i < 90; ++i) counts.show();
  counts.drop(DropReason::kReplaced, 3);
  counts.drop(DropReason::kCamera, 2);
  counts.drop(DropReason::kReplaced, 0);
  counts.drop(DropReason::kStopped);
  EXPECT_EQ(counts.shown(), 90u);
  EXPECT_EQ(counts.dropped(DropReason::kReplaced), 3u);
  EXPECT_EQ(counts.dropped(DropReason::kPaused), 0u);
  EXPECT_EQ(counts.dropped(), 6u);
  EXPECT_EQ(counts.captured(), 96u);
}

TEST(FrameCounts, TellEachReasonThereWas) {
  FrameCounts counts;
  counts.show();
  EXPECT_EQ(counts.summary(500ms), "showed 1 frame in 0.5 s (2.0 frames/s); dropped 0");
  counts.show();
  counts.drop(DropReason::kPaused, 4);
  EXPECT_EQ(counts.summary(2s),
            "showed 2 frames in 2.0 s (1.0 frames/s); dropped 4: 4 while paused");
  counts.drop(DropReason::kCamera, 5);
  counts.drop(DropReason::kReplaced, 6);
  counts.drop(DropReason::kStopped);
  EXPECT_EQ(counts.summary(0s),
            "showed 2 frames in 0.0 s (0.0 frames/s); dropped 16: 5 left out by the camera, "
            "6 replaced by a newer one, 4 while paused, 1 unfinished at the end");
}

}  // namespace
}  // namespace pleinair::app
