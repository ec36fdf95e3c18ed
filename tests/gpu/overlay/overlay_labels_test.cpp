// Labels on a walkaround: they go with the machine, and lie over nothing that they point at.
#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "tests/gpu/overlay/overlay_fixture.h"
#include "tests/reports/overlay/label_walkaround.h"

namespace pleinair {
namespace {

using overlay_truth::LabelTrack;
using overlay_truth::LabelWalkaround;

TEST_F(OverlayTest, LabelsLieOverNothingThatTheyPointAtOnAWalkaround) {
  constexpr int kFrames = 40;
  LabelWalkaround walk(true);
  walk.play(kFrames);
  ASSERT_EQ(walk.tracks.size(), 4U);
  EXPECT_GE(walk.shown, kFrames * 9 / 10);
  EXPECT_GE(walk.placed, 4 * walk.shown * 9 / 10);
  EXPECT_EQ(walk.overlapPx, 0);
  EXPECT_GT(walk.partPx, 1000);
  EXPECT_EQ(walk.coveredPx, 0);
}

TEST_F(OverlayTest, ALabelGoesWithTheMachineOnAWalkaround) {
  constexpr std::size_t kTwoSeconds = 40;
  LabelWalkaround walk(false);
  walk.play(60);
  ASSERT_EQ(walk.tracks.size(), 1U);
  std::vector<LabelTrack> tracks = std::move(walk.tracks.front().completed);
  tracks.push_back(std::move(walk.tracks.front()));
  const auto lengthOf = [](const LabelTrack& each) { return each.x.size(); };
  const LabelTrack& longest = *std::ranges::max_element(tracks, {}, lengthOf);
  ASSERT_GE(longest.x.size(), kTwoSeconds) << "it is laid out again for a reason only";
  const double drift = longest.driftPxPerSecond();
  std::printf("a label: %.2f px/s against the machine, for %zu frames\n", drift, longest.x.size());
  RecordProperty("label_px_per_s", std::to_string(drift));
  EXPECT_LE(drift, 0.5);
}

}  // namespace
}  // namespace pleinair
