// Aravis itself, with a simulated GigE Vision camera that sends real packets over the loopback
// device, in real time.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/cameras/aravis/aravis_camera.h"
#include "hal/cameras/aravis/aravis_kind.h"
#include "hal/supervisor/camera_selector.h"
#include "hal/supervisor/camera_supervisor.h"
#include "hal/supervisor/worker_camera.h"
#include "tests/support/gige_simulator.h"

namespace pleinair::hal::aravis {
namespace {

using namespace std::chrono_literals;

[[maybe_unused]] const bool kHasPrivateNetwork = support::enterPrivateNetwork();

constexpr const char* kAddress = "127.0.0.1";

class AravisLoopbackTest : public testing::Test {
 protected:
  void SetUp() override {
    simulator_ = std::make_unique<support::GigeSimulator>();
    if (!simulator_->isRunning()) GTEST_SKIP() << "another program has UDP port 3956";
  }

  std::unique_ptr<Camera> camera(AravisOptions options = {.pixelFormat = "Mono8"}) {
    return std::make_unique<AravisCamera>(kAddress, options, systemLibrary(), clock_);
  }

  SteadyClock clock_;
  std::unique_ptr<support::GigeSimulator> simulator_;
};

TEST_F(AravisLoopbackTest, IsFoundAndDescribed) {
  const auto cameras = AravisBackend().list();
  ASSERT_TRUE(cameras);
  ASSERT_EQ(cameras->size(), 1u);
  EXPECT_EQ(cameras->front().identity.id, "Aravis-Fake-GV01");
  EXPECT_EQ(cameras->front().identity.description, "Aravis Fake");
  EXPECT_EQ(cameras->front().serial, "GV01");
  EXPECT_EQ(cameras->front().node, kAddress);
  EXPECT_TRUE(AravisBackend({}, {.gige = false, .usb3 = false}).list()->empty());
  // Switched on again for the other tests of this process.
  EXPECT_EQ(AravisBackend().list()->size(), 1u);
}

TEST_F(AravisLoopbackTest, DeliversThePixelsThatWereSent) {
  for (const std::string format : {"Mono8", "BayerRG8", "RGB8"}) {
    const auto camera = this->camera({.pixelFormat = format});
    const auto stream = camera->start({.size = FrameSize{320, 240}, .framePeriod = 20ms});
    ASSERT_TRUE(stream) << stream.error().message();
    EXPECT_EQ(stream->frame.size, (FrameSize{320, 240}));
    EXPECT_EQ(stream->framePeriod, Duration(20ms));
    for (int n = 0; n < 5; ++n) {
      const NextFrame next = camera->next(clock_.now() + 2s);
      const auto* frame = std::get_if<CapturedFrame>(&next);
      ASSERT_NE(frame, nullptr) << format;
      const auto bytes = frame->image.map().view().planes[0].bytes;
      ASSERT_GE(bytes.size(), 320u * 240u);
      for (std::size_t i = 0; i < bytes.size(); ++i) {
        ASSERT_EQ(bytes[i], static_cast<std::uint8_t>(bytes[0] + i)) << format << ", byte " << i;
      }
      EXPECT_LE(frame->captureTime, clock_.now());
      EXPECT_GT(frame->captureTime, clock_.now() - 1s);
    }
  }
}

TEST_F(AravisLoopbackTest, FramesInPacketsThatTheNetworkDoesNotTakeAreInvalid) {
  if (!kHasPrivateNetwork || !support::setLoopbackMtu(1000)) GTEST_SKIP() << "its MTU is not ours";
  struct Restored {
    ~Restored() { EXPECT_TRUE(support::setLoopbackMtu(65536)); }
  } const restored;
  const auto large = camera({.pixelFormat = "Mono8", .packetBytes = 1500});
  const auto stream = large->start({.size = FrameSize{320, 240}, .framePeriod = 20ms});
  ASSERT_TRUE(stream) << stream.error().message();
  for (int n = 0; n < 5; ++n) {
    const NextFrame next = large->next(clock_.now() + 2s);
    const auto* frame = std::get_if<CapturedFrame>(&next);
    // The packets that begin and end a frame are small enough.
    ASSERT_NE(frame, nullptr) << n;
    EXPECT_NE(frame->health, FrameHealth::kValid) << n;
  }
}

TEST_F(AravisLoopbackTest, TriggersBySoftware) {
  const auto camera = this->camera({.pixelFormat = "Mono8", .trigger = "software"});
  ASSERT_TRUE(camera->start({.size = FrameSize{64, 48}, .framePeriod = 50ms}));
  const TimePoint begin = clock_.now();
  for (int n = 0; n < 10; ++n) {
    ASSERT_TRUE(std::holds_alternative<CapturedFrame>(camera->next(clock_.now() + 2s))) << n;
  }
  EXPECT_GE(clock_.now() - begin, Duration(430ms)) << "at the program's rate";
}

TEST_F(AravisLoopbackTest, ObeysOneControllerAtATime) {
  const auto first = camera();
  ASSERT_TRUE(first->start({.size = FrameSize{64, 48}}));
  const auto second = camera();
  const auto refused = second->start({.size = FrameSize{32, 24}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kBusy) << refused.error().message();
  const NextFrame next = first->next(clock_.now() + 2s);
  ASSERT_TRUE(std::holds_alternative<CapturedFrame>(next)) << "the first goes on";
  EXPECT_EQ(std::get<CapturedFrame>(next).image.format.size, (FrameSize{64, 48}));
  first->stop();
  EXPECT_TRUE(second->start({.size = FrameSize{32, 24}}));
}

TEST_F(AravisLoopbackTest, CountsEveryFrameThatASmallSocketBufferLoses) {
  // 1 kB takes no two packets: nearly every frame loses some.
  const auto camera = this->camera({.pixelFormat = "RGB8",
                                    .packetBytes = 1500,
                                    .resends = false,
                                    .socketBufferBytes = 1024,
                                    .packetSocket = false,
                                    .buffers = 16});
  ASSERT_TRUE(camera->start({.size = FrameSize{640, 480}, .framePeriod = 20ms}));
  std::uint64_t incomplete = 0, seen = 0, dropped = 0;
  LinkCounts link;
  for (const TimePoint until = clock_.now() + 2s; clock_.now() < until;) {
    const NextFrame next = camera->next(until);
    const auto* frame = std::get_if<CapturedFrame>(&next);
    if (frame == nullptr) continue;
    ++seen;
    dropped += frame->droppedBefore;
    if (frame->health != FrameHealth::kValid) ++incomplete;
    link = link + frame->linkBefore;
  }
  EXPECT_GT(incomplete + dropped, 0u);
  if (incomplete > 0) {
    EXPECT_GT(link.missingPackets, 0u);
  }
  // Frames at both ends are still on their way, or were made before the first one arrived.
  EXPECT_NEAR(static_cast<double>(seen + dropped), static_cast<double>(simulator_->framesMade()),
              20.0);
}

/// A supervised camera on its driver thread, as the program has it.
class AravisSupervisedTest : public AravisLoopbackTest {
 protected:
  std::optional<SupervisedFrame> frameWithin(Duration limit) {
    for (const TimePoint until = clock_.now() + limit; clock_.now() < until;) {
      SupervisedNext next = supervisor_.next(until);
      if (auto* frame = std::get_if<SupervisedFrame>(&next)) return std::move(*frame);
      if (const auto* state = std::get_if<CameraStateChanged>(&next)) {
        states_.push_back(state->state);
      }
    }
    return std::nullopt;
  }
  bool has(CameraState state) const { return std::ranges::count(states_, state) > 0; }

  CameraSelector selector_{
      {{.backend = std::make_shared<AravisBackend>(AravisOptions{.pixelFormat = "Mono8"})}},
      "aravis:127.0.0.1",
      clock_,
      onDriverThreads()};
  CameraSupervisor supervisor_{selector_, clock_, {}, {.size = FrameSize{320, 240}}};
  std::vector<CameraState> states_;
};

TEST_F(AravisSupervisedTest, ComesBackAfterItWasKilled) {
  ASSERT_TRUE(frameWithin(5s));
  simulator_.reset();
  const TimePoint killed = clock_.now();
  while (clock_.now() < killed + 3s && !has(CameraState::kStalled)) frameWithin(100ms);
  EXPECT_TRUE(has(CameraState::kStalled));
  while (clock_.now() < killed + 12s && !has(CameraState::kBackingOff)) frameWithin(100ms);
  EXPECT_TRUE(has(CameraState::kBackingOff)) << "it does not wait for Aravis, which blocks";
  EXPECT_LT(clock_.now() - killed, Duration(8s));

  simulator_ = std::make_unique<support::GigeSimulator>();
  const TimePoint back = clock_.now();
  ASSERT_TRUE(frameWithin(15s));
  RecordProperty("reopened_ms", static_cast<int>(toMilliseconds(clock_.now() - back)));
  EXPECT_EQ(supervisor_.status().counts.losses, 1u);
}

TEST_F(AravisSupervisedTest, EndsWithinTwoSecondsWhileAravisBlocks) {
  ASSERT_TRUE(frameWithin(5s));
  simulator_.reset();
  frameWithin(500ms);
  const TimePoint begin = clock_.now();
  supervisor_.stop();
  while (!std::holds_alternative<EndOfStream>(supervisor_.next(clock_.now() + 1s))) {
  }
  EXPECT_LT(clock_.now() - begin, Duration(2s));
}

}  // namespace
}  // namespace pleinair::hal::aravis
