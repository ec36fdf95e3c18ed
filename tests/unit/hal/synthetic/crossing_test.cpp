// The shot kCrossing: two persons pass each other before a camera that stands.
#include <algorithm>
#include <array>
#include <cstddef>

#include <glm/vec2.hpp>

#include "hal/cameras/synthetic/render/visitors.h"
#include "hal/cameras/synthetic/world/figure.h"
#include "hal/cameras/synthetic/world/world.h"
#include "tests/unit/hal/synthetic/captured.h"
#include "tests/unit/hal/synthetic/ray_oracle.h"

namespace pleinair::hal::synthetic {
namespace {

// Frames of 200 ms.
constexpr std::uint64_t kBeforeTheyMeet = 14;
constexpr std::uint64_t kWhenTheyMeet = 16;
constexpr std::uint64_t kEmptyAgain = 29;

const SyntheticOptions kCrossing = noiseFreeOptions(SyntheticShot::kCrossing);

/// The figure that a body is a part of; kFigures if it is none's.
std::size_t figureOf(Body body) {
  return body < kFirstOfFigures ? kFigures : (body - kFirstOfFigures) / kPartsPerFigure;
}

TEST(SyntheticCrossing, BeginsAndEndsWithAnEmptyRoom) {
  SteppedClock clock;
  const SyntheticCamera camera(kCrossing, clock);
  for (const std::uint64_t frame : {std::uint64_t{0}, std::uint64_t{5}, kEmptyAgain}) {
    EXPECT_EQ(shareOf(camera.movingMask(frame)), 0) << frame;
  }
  EXPECT_GT(shareOf(camera.movingMask(kWhenTheyMeet)), 0.05);
  const std::vector<Image> frames = capturedFrames(kCrossing, kEmptyAgain + 1);
  EXPECT_TRUE(std::ranges::equal(bytesOf(frames[0]), bytesOf(frames[kEmptyAgain])));
}

TEST(SyntheticCrossing, PersonsPassWithoutTouchingEachOther) {
  const Motion motion(SyntheticShot::kCrossing, 1);
  constexpr double kFarthestLimb = 0.12;  // metres, of a part beside its joint
  bool areSidesChanged = false;
  for (double t = 0; t < kCrossingSeconds; t += 1 / 30.0) {
    const BodyPoses bodies = motion.bodies(t);
    double behind = 1e9;
    double before = -1e9;
    for (std::size_t part = 0; part < kPartsPerFigure; ++part) {
      behind = std::min(behind, bodies[bodyOf(0, static_cast<FigurePart>(part))][3].y);
      before = std::max(before, bodies[bodyOf(1, static_cast<FigurePart>(part))][3].y);
    }
    EXPECT_GT(behind - before, 2 * kFarthestLimb) << t;
    areSidesChanged |= bodies[bodyOf(0, FigurePart::kTrunk)][3].x >
                       bodies[bodyOf(1, FigurePart::kTrunk)][3].x + 0.5;
  }
  EXPECT_TRUE(areSidesChanged);
}

TEST(SyntheticCrossing, NearerPersonHidesTheOtherInMaskAndFlow) {
  SteppedClock clock;
  const SyntheticCamera camera(kCrossing, clock);
  const Motion motion(kCrossing.shot, kCrossing.seed);
  const Exposure meeting(kCrossing.size, motion, kWhenTheyMeet * kCrossing.framePeriod, {});
  const Exposure earlier(kCrossing.size, motion, kBeforeTheyMeet * kCrossing.framePeriod, {});
  const MovingMask mask = camera.movingMask(kWhenTheyMeet);
  std::array<int, kFigures + 1> seen{};
  int hidden = 0;
  for (int y = 0; y < kCrossing.size.height; ++y) {
    for (int x = 0; x < kCrossing.size.width; ++x) {
      const glm::dvec2 pixel(x + 0.5, y + 0.5);
      const auto now = meeting.visibleAt(workbenchGeometry(), pixel);
      const std::size_t figure = now ? figureOf(now->body) : kFigures;
      ++seen.at(figure);
      EXPECT_EQ(mask.bytes[static_cast<std::size_t>(y * mask.size.width + x)] != 0,
                figure != kFigures);
      const auto before = earlier.visibleAt(workbenchGeometry(), pixel);
      if (!before || before->body != bodyOf(0, FigurePart::kTrunk)) continue;
      hidden += camera.flow(kBeforeTheyMeet, kWhenTheyMeet, pixel).visible ? 0 : 1;
    }
  }
  EXPECT_GT(seen[1], 700) << "the nearer one";
  EXPECT_GT(seen[0], 100) << "what is seen of the other";
  EXPECT_LT(seen[0], seen[1] / 2);
  EXPECT_GT(hidden, 100) << "px of the farther one's trunk";
}

}  // namespace
}  // namespace pleinair::hal::synthetic
