// Aravis itself behind a link that loses packets and changes their order, on the loopback device in
// real time.
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "hal/cameras/aravis/aravis_camera.h"
#include "hal/cameras/aravis/aravis_kind.h"
#include "hal/supervisor/camera_selector.h"
#include "hal/supervisor/camera_supervisor.h"
#include "hal/supervisor/worker_camera.h"
#include "tests/support/gige_relay.h"
#include "tests/support/gige_simulator.h"

namespace pleinair::hal::aravis {
namespace {

using namespace std::chrono_literals;

/// More than what is still on its way when the last affected frame has come.
constexpr std::uint64_t kAfter = 5;

class LossyLinkTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!simulator_.isRunning()) GTEST_SKIP() << "another program has UDP port 3956";
  }

  /// Takes frames through a relay, until all that it affects have come.
  void receive(support::LinkFaults faults, bool resends = true) {
    whole_ = incomplete_ = dropped_ = 0;
    link_ = {};
    const support::GigeRelay relay(faults);
    ASSERT_TRUE(relay.isRunning());
    AravisCamera camera(support::GigeRelay::kAddress,
                        {.pixelFormat = "Mono8",
                         .packetBytes = 1500,
                         .resends = resends,
                         .packetSocket = false,
                         .buffers = 16},
                        systemLibrary(), clock_);
    const auto stream = camera.start({.size = FrameSize{320, 240}, .framePeriod = 20ms});
    ASSERT_TRUE(stream) << stream.error().message();
    while (whole_ + incomplete_ + dropped_ < faults.frames + kAfter) {
      const NextFrame next = camera.next(clock_.now() + 3s);
      const auto* frame = std::get_if<CapturedFrame>(&next);
      ASSERT_NE(frame, nullptr) << "after " << whole_ << " whole and " << incomplete_ << " others";
      ++(frame->health == FrameHealth::kValid ? whole_ : incomplete_);
      dropped_ += frame->droppedBefore;
      link_ = link_ + frame->linkBefore;
    }
    sent_ = relay.counts();
  }

  /// The same, again where a machine that is busy with other work has lost something itself.
  void receiveQuietly(support::LinkFaults faults) {
    const auto isQuiet = [&] {
      return dropped_ == 0 && link_.resentPackets == sent_.recovered &&
             link_.missingPackets == sent_.injected - sent_.recovered &&
             incomplete_ == sent_.framesNotWhole;
    };
    for (int attempt = 0; attempt < 3; ++attempt) {
      receive(faults);
      if (HasFatalFailure() || isQuiet()) break;
    }
    std::printf(
        "of %ju packets lost, %ju were recovered, %ju counted as missing; frames: %ju "
        "whole, %ju incomplete\n",
        std::uintmax_t{sent_.injected}, std::uintmax_t{sent_.recovered},
        std::uintmax_t{link_.missingPackets}, std::uintmax_t{whole_}, std::uintmax_t{incomplete_});
  }

  SteadyClock clock_;
  support::GigeSimulator simulator_;
  support::RelayCounts sent_;
  std::uint64_t whole_ = 0, incomplete_ = 0, dropped_ = 0;
  LinkCounts link_;
};

TEST_F(LossyLinkTest, OnePerCentOfThePacketsIsLostAndRecovered) {
  receiveQuietly({.lost = 0.01, .frames = 400});
  EXPECT_GT(sent_.injected, 150u);
  EXPECT_EQ(link_.resentPackets, sent_.recovered);
  EXPECT_EQ(incomplete_, sent_.framesNotWhole);
  EXPECT_EQ(dropped_, 0u);
  EXPECT_GE(static_cast<double>(whole_), 0.995 * static_cast<double>(whole_ + incomplete_));
  EXPECT_EQ(link_.missingPackets, sent_.injected - sent_.recovered);
}

TEST_F(LossyLinkTest, EveryFrameWithAPacketThatIsNotRecoveredIsCounted) {
  receiveQuietly({.lost = 0.01, .beyondRecovery = 0.1, .frames = 300});
  EXPECT_GT(sent_.framesNotWhole, 0u);
  EXPECT_EQ(incomplete_, sent_.framesNotWhole);
  EXPECT_EQ(dropped_, 0u);
  EXPECT_EQ(link_.resentPackets, sent_.recovered);
  EXPECT_GT(sent_.injected, sent_.recovered);
  EXPECT_EQ(link_.missingPackets, sent_.injected - sent_.recovered);
}

TEST_F(LossyLinkTest, WithoutResendsEachFrameWithALossIsCounted) {
  receive({.lost = 0.01, .frames = 200}, false);
  EXPECT_GT(sent_.framesWithLoss, 50u) << "or the tests above prove nothing";
  EXPECT_LE(whole_, whole_ + incomplete_ + dropped_ - sent_.framesWithLoss);
  EXPECT_GT(incomplete_, 0u);
  EXPECT_EQ(link_.resentPackets, 0u);
}

TEST_F(LossyLinkTest, ACableThatIsOutForTwoSecondsEndsNothing) {
  support::GigeRelay relay({});
  ASSERT_TRUE(relay.isRunning());
  CameraSelector selector{{{.backend = std::make_shared<AravisBackend>(
                                AravisOptions{.pixelFormat = "Mono8", .packetSocket = false})}},
                          std::string("aravis:") + support::GigeRelay::kAddress,
                          clock_,
                          onDriverThreads()};
  CameraSupervisor supervisor{
      selector, clock_, {}, {.size = FrameSize{320, 240}, .framePeriod = 40ms}};
  std::vector<CameraState> states;
  const auto frameWithin = [&](Duration limit) {
    for (const TimePoint until = clock_.now() + limit; clock_.now() < until;) {
      const SupervisedNext next = supervisor.next(until);
      if (std::holds_alternative<SupervisedFrame>(next)) return true;
      if (const auto* state = std::get_if<CameraStateChanged>(&next))
        states.push_back(state->state);
    }
    return false;
  };
  ASSERT_TRUE(frameWithin(10s));
  relay.setUnplugged(true);
  for (const TimePoint until = clock_.now() + 2s; clock_.now() < until;)
    frameWithin(until - clock_.now());
  EXPECT_EQ(supervisor.status().state, CameraState::kStalled);
  relay.setUnplugged(false);
  EXPECT_TRUE(frameWithin(3s));
  EXPECT_EQ(supervisor.status().state, CameraState::kStreaming);
  EXPECT_EQ(supervisor.status().counts.losses, 0u) << "it was not opened anew";
  EXPECT_GT(supervisor.status().counts.frames.lostInStall, 0u);
}

/// Packets that no camera sends never reach Aravis, which takes their sizes and numbers for
/// granted.
TEST_F(LossyLinkTest, PacketsThatNoCameraSendsAreDropped) {
  support::GigeRelay relay({});
  ASSERT_TRUE(relay.isRunning());
  AravisCamera camera(support::GigeRelay::kAddress,
                      {.pixelFormat = "Mono8", .packetBytes = 1500, .packetSocket = false},
                      systemLibrary(), clock_);
  const auto stream = camera.start({.size = FrameSize{320, 240}, .framePeriod = 20ms});
  ASSERT_TRUE(stream) << stream.error().message();
  // Status, the frame's number far ahead, format, the packet's number; then its content.
  constexpr std::uint8_t kPayload = 3, kMultipart = 7, kLong = 0x80;
  const auto packet = [](std::uint8_t format, std::uint8_t number, std::size_t length) {
    std::vector<std::uint8_t> bytes(64);
    bytes[2] = 0x60;
    bytes[4] = format;
    bytes[7] = number;
    bytes[14] = 1;  // the place of a part of several: 256
    bytes.resize(length);
    return bytes;
  };
  std::uint64_t others = 0;
  for (int n = 0; n < 20; ++n) {
    for (std::size_t length = 0; length < 8; ++length) {
      relay.sendAlien(packet(kPayload, 2, length));  // shorter than its header
    }
    relay.sendAlien(packet(kLong | kPayload, 2, 19));
    relay.sendAlien(packet(kMultipart, 2, 15));  // Aravis: copies 2^64 - 1 bytes
    relay.sendAlien(packet(kPayload, 200, 64));  // a frame has 55 packets
    relay.sendAlien(packet(9, 2, 64));
    const NextFrame next = camera.next(clock_.now() + 3s);
    const auto* frame = std::get_if<CapturedFrame>(&next);
    ASSERT_NE(frame, nullptr) << "after " << n << " frames";
    others += frame->droppedBefore + (frame->health == FrameHealth::kValid ? 0 : 1);
    others += frame->linkBefore.ignoredPackets;
  }
  EXPECT_EQ(others, 0u);
}

TEST_F(LossyLinkTest, PacketsInAnotherOrderCostNoFrames) {
  receiveQuietly({.reordered = 0.05, .frames = 200});
  EXPECT_GT(sent_.reordered, 300u);
  EXPECT_EQ(incomplete_, 0u);
  EXPECT_EQ(dropped_, 0u);
  EXPECT_EQ(link_.missingPackets, 0u);
}

}  // namespace
}  // namespace pleinair::hal::aravis
