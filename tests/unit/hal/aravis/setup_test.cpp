#include "hal/cameras/aravis/setup.h"

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/hal/aravis/fake_gige.h"

namespace pleinair::hal::aravis {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class AravisSetupTest : public FakeGigeTest {};

TEST_F(AravisSetupTest, TakesTheMiddleOfTheSensor) {
  ASSERT_TRUE(start({.size = FrameSize{66, 49}}));
  EXPECT_EQ(library_.told.region, (Region{32, 24, 64, 48})) << "in steps of 4 and 2";
  options.offsetX = 9;
  options.offsetY = 1000;
  ASSERT_TRUE(start());
  EXPECT_EQ(library_.told.region, (Region{8, 48, 64, 48})) << "as far as it fits";
  ASSERT_TRUE(start({}));
  EXPECT_EQ(library_.told.region, (Region{0, 0, 128, 96})) << "all of it";
}

TEST_F(AravisSetupTest, RefusesBoundsThatHoldNoRegion) {
  fake.bounds.width = {128, 16, 4};
  EXPECT_EQ(failure(),
            "aravis:Fake-Cam-1: gives regions of 128 to 16 by 2 to 96 px; update its firmware");
  fake.bounds.width = {16, 128, 0};  // no step
  fake.bounds.xStep = -4;
  EXPECT_EQ(start({.size = FrameSize{66, 49}})->frame.size, (FrameSize{66, 48}));
}

TEST_F(AravisSetupTest, RefusesPairsThatGoOnAcrossTheEndsOfRows) {
  fake.formats = {0x02100032};  // YUV422_8
  fake.bounds.width = {127, 127, 1};
  EXPECT_EQ(failure(),
            "aravis:Fake-Cam-1: gives rows of 127 px in YUV422_8, whose pixels are paired; set "
            "camera.aravis.pixel_format to another of its formats");
  fake.bounds.width = {126, 126, 1};
  EXPECT_EQ(failure(), "started");
}

TEST_F(AravisSetupTest, KeepsMosaicsInPhase) {
  fake.formats = {0x01080009};
  fake.bounds = {.width = {1, 127, 1}, .height = {1, 95, 1}, .xStep = 1, .yStep = 1};
  const Result<StreamFormat> format = start({.size = FrameSize{65, 47}});
  ASSERT_TRUE(format);
  EXPECT_EQ(format->frame.size, (FrameSize{64, 46}));
  EXPECT_EQ(library_.told.region.x % 2, 0);
  EXPECT_EQ(library_.told.region.y % 2, 0);
  fake.formats = {0x01080001};
  EXPECT_EQ(start({.size = FrameSize{65, 47}})->frame.size, (FrameSize{65, 47}));
}

TEST_F(AravisSetupTest, BinsBeforeItCuts) {
  options.binning = 2;
  EXPECT_EQ(start({})->frame.size, (FrameSize{64, 48}));
  EXPECT_EQ(library_.told.binning, 2);
  options.binning = 5;
  EXPECT_EQ(failure(),
            "aravis:Fake-Cam-1: cannot bin 5 times; "
            "set camera.aravis.binning to at most 4");
  fake.maxBinning.reset();
  EXPECT_THAT(failure(), HasSubstr("cannot bin; set camera.aravis.binning to 1"));
  options.binning = 1;
  EXPECT_EQ(failure(), "started");
}

TEST_F(AravisSetupTest, ReadsTheRateBack) {
  EXPECT_EQ(start({.framePeriod = 20ms})->framePeriod, Duration(20ms));
  EXPECT_EQ(start({.framePeriod = 1ms})->framePeriod, Duration(10ms)) << "its highest";
  fake.maxRate = 0;
  EXPECT_FALSE(start({.framePeriod = 20ms})->framePeriod) << "it does not say";
}

TEST_F(AravisSetupTest, SetsControlsWithinTheirRanges) {
  ASSERT_TRUE(start({.controls = {.exposure = Duration(8ms), .gain = 0.25}}));
  EXPECT_DOUBLE_EQ(library_.told.values[Control::kExposure], 8000) << "microseconds";
  EXPECT_FALSE(library_.told.automatic[Control::kExposure]);
  EXPECT_DOUBLE_EQ(library_.told.values[Control::kGain], 6);
  ASSERT_TRUE(start({.controls = {.exposure = Duration(8s)}}));
  EXPECT_DOUBLE_EQ(library_.told.values[Control::kExposure], 100'000);
  ASSERT_TRUE(start({.controls = {.exposure = Automatic{}}}));
  EXPECT_TRUE(library_.told.automatic[Control::kExposure]);
}

TEST_F(AravisSetupTest, SaysWhichControlsThereAre) {
  EXPECT_EQ(failure({.controls = {.gain = Automatic{}}}),
            "aravis:Fake-Cam-1: has no control of automatic gain; remove the setting; the device "
            "has exposure, gain (no auto)");
  EXPECT_THAT(failure({.controls = {.focus = 0.5}}), HasSubstr("has no control of focus"));
  EXPECT_THAT(failure({.controls = {.whiteBalance = 5000.0}}),
              HasSubstr("has no control of white_balance in K"));
  fake.ranges.clear();
  fake.automatic = {Control::kWhiteBalance};
  EXPECT_EQ(failure({.controls = {.whiteBalance = Automatic{}}}), "started");
  EXPECT_THAT(failure({.controls = {.gain = 0.5}}),
              HasSubstr("the device has white_balance (auto only)"));
}

TEST_F(AravisSetupTest, SaysWhichTriggersThereAre) {
  options.trigger = "Line7";
  EXPECT_EQ(failure(),
            "aravis:Fake-Cam-1: has no trigger \"Line7\"; set camera.aravis.trigger to "
            "free, Line0, Line1, Software");
  fake.triggers.clear();
  options.trigger = "software";
  EXPECT_THAT(failure(), HasSubstr("set camera.aravis.trigger to free"));
}

TEST_F(AravisSetupTest, PassesTheLinkSettingsOn) {
  options.packetBytes = 9000;
  options.resends = false;
  options.frameRetention = 250ms;
  options.socketBufferBytes = 1 << 20;
  options.packetSocket = false;
  ASSERT_TRUE(start());
  EXPECT_EQ(library_.told.packetBytes, 9000);
  EXPECT_FALSE(library_.told.settings.resends);
  EXPECT_EQ(library_.told.settings.frameRetention, Duration(250ms));
  EXPECT_EQ(library_.told.settings.socketBufferBytes, 1u << 20);
  EXPECT_FALSE(library_.told.settings.usesPacketSocket);
  EXPECT_TRUE(library_.told.chunks);
  fake.transport = Transport::kUsb3;
  options.chunkTimestamps = false;
  ASSERT_TRUE(start());
  EXPECT_EQ(library_.told.packetBytes, -1) << "USB has none";
  EXPECT_FALSE(library_.told.chunks);
}

}  // namespace
}  // namespace pleinair::hal::aravis
