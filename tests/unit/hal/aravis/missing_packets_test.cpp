#include "hal/cameras/aravis/missing_packets.h"

#include <optional>

#include <gtest/gtest.h>

namespace pleinair::hal::aravis {
namespace {

// 76,800 bytes in packets of 1464: 53 packets, a leader and a trailer.
constexpr std::size_t kPayload = 320UL * 240;
constexpr std::uint64_t kPerFrame = 55;

TEST(MissingPackets, AreWhatFramesConsistOfLessWhatCame) {
  MissingPackets missing(kPayload, 1500, false);
  missing.frameEnded(kPerFrame, std::nullopt);
  EXPECT_EQ(missing.count(), 0u);
  missing.frameEnded(2 * kPerFrame - 3, std::nullopt);
  EXPECT_EQ(missing.count(), 3u);
  missing.frameEnded(3 * kPerFrame - 3, std::nullopt);
  EXPECT_EQ(missing.count(), 3u);
}

TEST(MissingPackets, DoNotFallWhileALaterFrameIsOnItsWay) {
  MissingPackets missing(kPayload, 1500, false);
  missing.frameEnded(kPerFrame - 4, std::nullopt);
  missing.frameEnded(2 * kPerFrame - 4 + 20, std::nullopt);  // 20 packets of the third one
  EXPECT_EQ(missing.count(), 4u);
  missing.frameEnded(3 * kPerFrame - 5, std::nullopt);
  EXPECT_EQ(missing.count(), 5u);
}

TEST(MissingPackets, FillTheirPacketsToTheEnd) {
  MissingPackets two(1464 * 2, 1500, false);
  two.frameEnded(0, std::nullopt);
  EXPECT_EQ(two.count(), 4u);
  MissingPackets more(1464 * 2 + 1, 1500, false);
  more.frameEnded(0, std::nullopt);
  EXPECT_EQ(more.count(), 5u);
  MissingPackets longIds(1452 * 2, 1500, true);
  longIds.frameEnded(0, std::nullopt);
  EXPECT_EQ(longIds.count(), 4u);
}

TEST(MissingPackets, AreNoneInWholeFramesOfAnotherSizeThanAnnounced) {
  MissingPackets missing(kPayload, 1500, false);
  missing.frameEnded(12, 1464 * 10);
  EXPECT_EQ(missing.count(), 0u);
  missing.frameEnded(12 + 102, 1464 * 100);
  EXPECT_EQ(missing.count(), 0u);
  missing.frameEnded(12 + 102 + kPerFrame - 1, std::nullopt);
  EXPECT_EQ(missing.count(), 1u);
}

TEST(MissingPackets, OfAnUnknownSizeAreNotCounted) {
  for (const std::size_t packet : {0, 36}) {
    MissingPackets missing(kPayload, packet, false);
    EXPECT_FALSE(missing.counts());
    missing.frameEnded(0, std::nullopt);
    EXPECT_EQ(missing.count(), 0u);
  }
  EXPECT_FALSE(MissingPackets().counts());
}

}  // namespace
}  // namespace pleinair::hal::aravis
