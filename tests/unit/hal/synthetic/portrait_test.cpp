// The shot kPortrait: a person comes close before a bare wall.
#include "hal/cameras/synthetic/render/portrait.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>

#include "hal/cameras/synthetic/world/figure.h"
#include "tests/unit/hal/synthetic/captured.h"

namespace pleinair::hal::synthetic {
namespace {

// Frames of 200 ms.
constexpr std::uint64_t kNobodyYet = 3;
constexpr std::uint64_t kIsThere = 20;
constexpr std::uint64_t kHasGone = 57;

const SyntheticOptions kPortrait = noiseFreeOptions(SyntheticShot::kPortrait);

TEST(SyntheticPortrait, APersonFillsAGoodPartOfTheMask) {
  SteppedClock clock;
  const SyntheticCamera camera(kPortrait, clock);
  for (const std::uint64_t frame : {std::uint64_t{0}, kNobodyYet, kHasGone}) {
    EXPECT_EQ(shareOf(camera.movingMask(frame)), 0) << frame;
  }
  EXPECT_GT(shareOf(camera.movingMask(kIsThere)), 0.2);
  EXPECT_LT(shareOf(camera.movingMask(kIsThere)), 0.6);
}

TEST(SyntheticPortrait, TheWallIsBare) {
  const std::vector<Image> frames = capturedFrames(kPortrait, 1);
  double sum = 0;
  double squares = 0;
  const auto bytes = bytesOf(frames[0]);
  for (const std::uint8_t byte : bytes) {
    sum += byte;
    squares += byte * byte;
  }
  const double mean = sum / static_cast<double>(bytes.size());
  EXPECT_GT(mean, 60);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(bytes.size()) - mean * mean), 6);
}

TEST(SyntheticPortrait, NeverRestsWhileItIsThere) {
  const Motion motion(SyntheticShot::kPortrait, 1);
  const Body head = bodyOf(0, FigurePart::kHead);
  for (double t = 2.5; t < 9; t += 0.2) {
    const glm::dmat4 now = motion.bodies(t)[head];
    const glm::dmat4 next = motion.bodies(t + 1 / 30.0)[head];
    double moved = 0;
    for (int axis = 0; axis < 4; ++axis) {
      moved = std::max(moved, glm::length(glm::dvec3(next[axis] - now[axis])));
    }
    EXPECT_GT(moved, 0.0005) << t;
    EXPECT_LT(moved, 0.08) << t;
  }
  EXPECT_EQ(motion.bodies(1.0)[head], motion.bodies(1.0 + kPortraitSeconds)[head]);
}

}  // namespace
}  // namespace pleinair::hal::synthetic
