#include <chrono>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/hal/aravis/fake_gige.h"

namespace pleinair::hal::aravis {
namespace {

using namespace std::chrono_literals;

class AravisFaultsTest : public FakeGigeTest {};

TEST_F(AravisFaultsTest, FramesThatLackPacketsAreIncomplete) {
  fake.frames[1] = {.missingPackets = 3, .status = BufferStatus::kMissingPackets};
  ASSERT_TRUE(start());
  EXPECT_EQ(frame().health, FrameHealth::kValid);
  const CapturedFrame broken = frame();
  EXPECT_EQ(broken.health, FrameHealth::kIncomplete);
  EXPECT_EQ(broken.linkBefore.missingPackets, 3u);
  EXPECT_EQ(broken.droppedBefore, 0u) << "it is no gap";
  EXPECT_TRUE(broken.image.isComplete()) << "its planes can be read all the same";
  EXPECT_EQ(frame().health, FrameHealth::kValid);
}

TEST_F(AravisFaultsTest, FramesThatAreNoImageOfTheFormatAreCorrupt) {
  fake.frames[0] = {.status = BufferStatus::kSizeMismatch};
  fake.frames[1] = {.status = BufferStatus::kOther};
  fake.frames[2] = {.pixelFormat = 0x02180014};
  fake.frames[3] = {.size = FrameSize{32, 48}};
  fake.frames[4] = {.usedBytes = 64 * 48 - 1};
  ASSERT_TRUE(start());
  for (int i = 0; i < 5; ++i) {
    const CapturedFrame broken = frame();
    EXPECT_EQ(broken.health, FrameHealth::kCorrupt) << i;
    EXPECT_TRUE(broken.image.isComplete()) << i;
    EXPECT_EQ(broken.image.format.size, (FrameSize{64, 48})) << i;
  }
  EXPECT_EQ(frame().health, FrameHealth::kValid);
}

TEST_F(AravisFaultsTest, BuffersThatAreGivenBackEmptyAreNoFrames) {
  fake.frames[0] = {.status = BufferStatus::kAborted};
  ASSERT_TRUE(start());
  EXPECT_EQ(frame().image.map().view().planes[0].bytes[0], 1) << "the second frame";
}

TEST_F(AravisFaultsTest, LosesTheCameraForGood) {
  fake.frames[2] = {.isLost = true};
  ASSERT_TRUE(start());
  frame();
  frame();
  for (int i = 0; i < 2; ++i) {
    const NextFrame next = camera_->next(clock_.now() + 1s);
    ASSERT_TRUE(std::holds_alternative<CameraLost>(next));
    EXPECT_EQ(std::get<CameraLost>(next).cause.message(),
              "aravis:Fake-Cam-1: no longer answers on the network; check its cable and its power");
  }
  fake.frames.clear();
  ASSERT_TRUE(start());
  EXPECT_EQ(frame().sequence, 0u);
}

TEST_F(AravisFaultsTest, RefusesACameraThatAnotherProgramControls) {
  fake.isController = false;
  const Result<StreamFormat> format = start();
  ASSERT_FALSE(format);
  EXPECT_EQ(format.error().kind, ErrorKind::kBusy);
  EXPECT_EQ(library_.told.open, 0) << "it is closed again";
}

TEST_F(AravisFaultsTest, LendsBuffersAndCopiesTheLast) {
  options.buffers = 5;
  ASSERT_TRUE(start());
  std::vector<CapturedFrame> held;
  for (std::uint8_t i = 0; i < 20; ++i) {
    held.push_back(frame());
    ASSERT_EQ(held.back().droppedBefore, 0u) << "a consumer that holds frames stops no stream";
  }
  for (std::uint8_t i = 0; i < 20; ++i) {
    EXPECT_EQ(held[i].image.map().view().planes[0].bytes[0], i)
        << "what is held is not written over";
  }
  held.clear();
  camera_.reset();
  EXPECT_EQ(library_.told.open, 0);
}

TEST_F(AravisFaultsTest, UnpacksTwelveBitsAcrossTheEndsOfRows) {
  fake.formats = {0x010C0047};
  fake.bounds = {.width = {1, 128, 1}, .height = {1, 96, 1}};
  // Three rows of three: 9 samples in 14 bytes, whose upper bits are 0x10, 0x20 … 0x90.
  fake.frames[0].bytes = {0x00, 0x01, 0x20, 0x00, 0x03, 0x40, 0x00,
                          0x05, 0x60, 0x00, 0x07, 0x80, 0x00, 0x09};
  ASSERT_TRUE(start({.size = FrameSize{3, 3}}));
  const CapturedFrame unpacked = frame();
  EXPECT_EQ(unpacked.health, FrameHealth::kValid);
  EXPECT_EQ(unpacked.image.format.pixelFormat, PixelFormat::kGrey8);
  EXPECT_THAT(unpacked.image.map().view().planes[0].bytes,
              testing::ElementsAre(0x10, 0x20, 0x30, 0x40, 0x50, 0x60, 0x70, 0x80, 0x90));
}

TEST_F(AravisFaultsTest, TriggersOncePerPeriod) {
  options.trigger = "software";
  const Result<StreamFormat> format = start({.size = FrameSize{64, 48}, .framePeriod = 100ms});
  ASSERT_TRUE(format);
  EXPECT_FALSE(format->isTriggered) << "the program knows when frames are to come";
  EXPECT_EQ(format->framePeriod, Duration(100ms));
  const TimePoint until = clock_.now() + 1s - 1ms;
  while (clock_.now() < until) camera_->next(until);
  EXPECT_EQ(library_.told.triggers, 10);
}

TEST_F(AravisFaultsTest, ALineTriggerHasNoPeriod) {
  options.trigger = "line1";
  const Result<StreamFormat> format = start({.size = FrameSize{64, 48}, .framePeriod = 100ms});
  ASSERT_TRUE(format);
  EXPECT_TRUE(format->isTriggered);
  EXPECT_FALSE(format->framePeriod);
  EXPECT_EQ(library_.told.trigger, "Line1");
}

TEST_F(AravisFaultsTest, WarnsWhereTheSystemGrantsTooSmallASocketBuffer) {
  library_.mostSocketBytes = 212'992;
  EXPECT_EQ(start()->warning,
            "the system grants a socket buffer of 212 kB of 4194, so frames will be lost; "
            "sudo sysctl -w net.core.rmem_max=4194304");
  library_.hasPacketSocket = true;
  EXPECT_EQ(start()->warning, "") << "the socket's buffer is not used";
  options.packetSocket = false;
  EXPECT_NE(start()->warning, "");
  options.socketBufferBytes = 200'000;
  EXPECT_EQ(start()->warning, "");
  options.socketBufferBytes = 4 << 20;
  fake.transport = Transport::kUsb3;
  EXPECT_EQ(start()->warning, "");
}

}  // namespace
}  // namespace pleinair::hal::aravis
