// The shot kHand: an arm that reaches in slowly, rests, goes on and withdraws.
#include <algorithm>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "hal/cameras/synthetic/render/motion.h"
#include "hal/cameras/synthetic/synthetic_camera.h"
#include "tests/unit/hal/synthetic/captured.h"

namespace pleinair::hal::synthetic {
namespace {

// Frames of 200 ms.
constexpr std::uint64_t kReaches = 11;
constexpr std::uint64_t kRests = 18;
constexpr std::uint64_t kGoesOn = 26;
constexpr std::uint64_t kEmptyAfter = 45;

const SyntheticOptions kHand = noiseFreeOptions(SyntheticShot::kHand);

TEST(SyntheticHand, LeavesThePictureAsItWas) {
  const std::vector<Image> frames = capturedFrames(kHand, kEmptyAfter + 1);
  EXPECT_TRUE(std::ranges::equal(bytesOf(frames[0]), bytesOf(frames[kEmptyAfter])));
  EXPECT_FALSE(std::ranges::equal(bytesOf(frames[0]), bytesOf(frames[kRests])));
  EXPECT_TRUE(std::ranges::equal(bytesOf(frames[kRests]), bytesOf(frames[kRests + 1])))
      << "nothing moves while it rests";
}

TEST(SyntheticHand, IsInTheMaskWhileItIsThere) {
  SteppedClock clock;
  const SyntheticCamera camera(kHand, clock);
  EXPECT_EQ(shareOf(camera.movingMask(0)), 0);
  EXPECT_EQ(shareOf(camera.movingMask(kEmptyAfter)), 0);
  for (const std::uint64_t frame : {kReaches, kRests, kGoesOn}) {
    EXPECT_GT(shareOf(camera.movingMask(frame)), 0.02) << frame;
    EXPECT_LT(shareOf(camera.movingMask(frame)), 0.3) << frame;
  }
}

TEST(SyntheticHand, IsSlowerThanTheOccluderAndRestsForASecond) {
  const auto speedsOf = [](SyntheticShot shot) {
    const Motion motion(shot, 1);
    std::vector<double> metresPerSecond;
    for (int frame = 0; frame < 300; ++frame) {
      const glm::dvec3 from(motion.bodies(frame / 30.0)[kArm][3]);
      const glm::dvec3 to(motion.bodies((frame + 1) / 30.0)[kArm][3]);
      metresPerSecond.push_back(30 * glm::distance(from, to));
    }
    return metresPerSecond;
  };
  const std::vector<double> hand = speedsOf(SyntheticShot::kHand);
  EXPECT_LT(std::ranges::max(hand), 0.75 * std::ranges::max(speedsOf(SyntheticShot::kOccluder)));
  // Over the bench: between the frames in which it reaches in and withdraws.
  const auto resting = std::count_if(hand.begin() + 60, hand.begin() + 180,
                                     [](double speed) { return speed < 1e-6; });
  EXPECT_GE(resting, 28 + 11) << "for a second, and for 0.4 s before it withdraws";
  EXPECT_LE(resting, 32 + 13);
}

TEST(SyntheticHand, IsTheSameInEveryRoundBeforeAStandingCamera) {
  const Motion motion(SyntheticShot::kHand, 1);
  EXPECT_LT(glm::distance(motion.bodies(2.3)[kArm][3], motion.bodies(22.3)[kArm][3]), 1e-9);
  EXPECT_EQ(motion.cameraFromWorld(0), Motion(SyntheticShot::kHand, 2).cameraFromWorld(17.3));
}

TEST(SyntheticHand, UncoversWhatItHid) {
  SteppedClock clock;
  const SyntheticCamera camera(kHand, clock);
  const MovingMask before = camera.movingMask(kRests);
  const FlowField hidden = camera.flowField(0, kRests);
  const FlowField uncovered = camera.flowField(0, kEmptyAfter);
  for (std::size_t i = 0; i < before.bytes.size(); ++i) {
    EXPECT_EQ(hidden.visible[i] != 0, before.bytes[i] == 0) << i;
    EXPECT_EQ(uncovered.visible[i], 1) << i;
  }
}

}  // namespace
}  // namespace pleinair::hal::synthetic
