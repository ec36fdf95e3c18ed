#include "hal/captures/frame_facts.h"

#include <chrono>
#include <string>

#include <gtest/gtest.h>

namespace pleinair::hal::captures {
namespace {

using namespace std::chrono_literals;

TEST(FrameFacts, AreReadAsTheyWereWritten) {
  const FrameFacts all{.time = 1'234'567'891ns,
                       .droppedBefore = 3,
                       .underrunsBefore = 2,
                       .linkBefore = {.missingPackets = 5, .resentPackets = 6, .ignoredPackets = 7},
                       .timestampSource = TimestampSource::kStartOfExposure,
                       .deviceTime = 99s,
                       .health = FrameHealth::kIncomplete};
  EXPECT_EQ(textOf(all),
            "time=1234567891 dropped=3 underruns=2 missing=5 resent=6 ignored=7 "
            "device=99000000000 source=exposure health=incomplete");
  EXPECT_EQ(parseFacts(textOf(all)), all);
  EXPECT_EQ(textOf({}), "time=0 source=arrival health=valid");
  EXPECT_EQ(parseFacts(textOf({})), FrameFacts{});
}

TEST(FrameFacts, SkipWhatTheyDoNotKnow) {
  EXPECT_EQ(parseFacts("time=5 temperature=hot  odd"), FrameFacts{.time = 5ns});
}

TEST(FrameFacts, RefuseBrokenLines) {
  for (const std::string text :
       {"", "dropped=1", "time=", "time=x", "time=5x", "time=99999999999999999999",
        "time=5 dropped=-1", "time=5 health=fine", "time=5 source=", "time=9223372036854775807",
        "device=1"}) {
    EXPECT_FALSE(parseFacts(text)) << text;
  }
}

TEST(FrameFacts, CountTimeFromTheBeginningOfTheStream) {
  const CapturedFrame frame{.captureTime = TimePoint(7s), .deviceTime = 3s};
  EXPECT_EQ(factsOf(frame, TimePoint(5s)).time, Duration(2s));
  EXPECT_EQ(factsOf(frame, TimePoint(5s)).deviceTime, Duration(3s));
}

}  // namespace
}  // namespace pleinair::hal::captures
