#include "hal/cameras/synthetic/render/visitors.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "hal/cameras/synthetic/world/figure.h"
#include "hal/cameras/synthetic/world/world.h"
#include "tests/unit/hal/synthetic/captured.h"
#include "tests/unit/hal/synthetic/ray_oracle.h"

namespace pleinair::hal::synthetic {
namespace {

// Frames of 200 ms: the first person crosses in frames 9 to 27, the second one in 41 to 71.
constexpr std::uint64_t kFirstPerson = 16;
constexpr std::uint64_t kEmptyBetween = 32;
constexpr std::uint64_t kSecondStands = 56;
constexpr std::uint64_t kEmptyAfter = 77;

const SyntheticOptions kVisitors = noiseFreeOptions(SyntheticShot::kVisitors);

const std::vector<Image>& visitorFrames() {
  static const std::vector<Image> kFrames = capturedFrames(kVisitors, 97);
  return kFrames;
}

/// How many of the mask's rows show something that moves.
int rowsOf(const MovingMask& mask) {
  int rows = 0;
  for (int y = 0; y < mask.size.height; ++y) {
    const auto row = std::span(mask.bytes)
                         .subspan(static_cast<std::size_t>(y * mask.size.width),
                                  static_cast<std::size_t>(mask.size.width));
    rows += std::ranges::find(row, 255) != row.end() ? 1 : 0;
  }
  return rows;
}

TEST(SyntheticVisitors, LeaveThePictureAsItWas) {
  const std::vector<Image>& frames = visitorFrames();
  EXPECT_TRUE(std::ranges::equal(bytesOf(frames[0]), bytesOf(frames[kEmptyBetween])));
  EXPECT_TRUE(std::ranges::equal(bytesOf(frames[0]), bytesOf(frames[kEmptyAfter])));
  EXPECT_FALSE(std::ranges::equal(bytesOf(frames[0]), bytesOf(frames[kFirstPerson])));
}

TEST(SyntheticVisitors, AreTheSameOnEveryRunAndInEveryRound) {
  const std::vector<Image> again = capturedFrames(kVisitors, 17);
  EXPECT_TRUE(std::ranges::equal(bytesOf(visitorFrames()[16]), bytesOf(again[16])));
  const Motion motion(SyntheticShot::kVisitors, 1);
  const Body hand = bodyOf(1, FigurePart::kLeftForearm);
  for (const double t : {0.0, 3.1, 11.7}) {
    const glm::dmat4 later = motion.bodies(t + 2 * kVisitorsSeconds)[hand];
    EXPECT_LT(glm::distance(motion.bodies(t)[hand][3], later[3]), 1e-9);
  }
}

TEST(SyntheticVisitors, ChangeOnlyThePixelsOfTheMask) {
  SteppedClock clock;
  const SyntheticCamera camera(kVisitors, clock);
  for (const std::uint64_t frame : {kFirstPerson, kSecondStands}) {
    const MovingMask mask = camera.movingMask(frame);
    const auto before = bytesOf(visitorFrames()[0]);
    const auto now = bytesOf(visitorFrames()[frame]);
    int changed = 0;
    for (int y = 1; y + 1 < mask.size.height; ++y) {
      for (int x = 1; x + 1 < mask.size.width; ++x) {
        // A pixel at an edge shows a share of the person, whichever surface its centre meets.
        bool isNear = false;
        for (int i = 0; i < 9; ++i) {
          const int at = (y + i / 3 - 1) * mask.size.width + x + i % 3 - 1;
          isNear |= mask.bytes[static_cast<std::size_t>(at)] != 0;
        }
        const auto k = 3 * static_cast<std::size_t>(y * mask.size.width + x);
        int difference = 0;
        for (std::size_t i = k; i < k + 3; ++i) {
          difference = std::max(difference, std::abs(now[i] - before[i]));
        }
        // Pixels beside a person begin their run of approximated perspective elsewhere.
        constexpr int kRounding = 1;
        EXPECT_TRUE(isNear || difference <= kRounding) << x << " " << y << ": " << difference;
        changed += difference > kRounding ? 1 : 0;
      }
    }
    EXPECT_GT(changed, 500);
  }
}

TEST(SyntheticVisitors, AreInTheMaskWhileTheyCross) {
  SteppedClock clock;
  const SyntheticCamera camera(kVisitors, clock);
  for (const std::uint64_t frame : {std::uint64_t{0}, kEmptyBetween, kEmptyAfter}) {
    EXPECT_EQ(shareOf(camera.movingMask(frame)), 0) << frame;
  }
  for (const std::uint64_t frame : {kFirstPerson, kSecondStands}) {
    const MovingMask mask = camera.movingMask(frame);
    EXPECT_EQ(mask.size, (FrameSize{160, 120}));
    EXPECT_GT(shareOf(mask), 0.03) << frame;
    EXPECT_LT(shareOf(mask), 0.15) << frame;
    EXPECT_GT(rowsOf(mask), 60) << "at least half the picture high";
    EXPECT_LT(rowsOf(mask), 80) << "at most two thirds";
    const MovingMask coarse = camera.movingMask(frame, 3);
    EXPECT_EQ(coarse.size, (FrameSize{54, 40}));
    EXPECT_EQ(coarse.bytes[20 * 54 + 26], mask.bytes[60 * 160 + 78]);
    EXPECT_NEAR(shareOf(coarse), shareOf(mask), 0.02);
  }
}

TEST(SyntheticVisitors, AreNotTheOnlyThingsOfTheMask) {
  SteppedClock clock;
  SyntheticOptions options = smallOptions();
  options.shot = SyntheticShot::kOccluder;
  const SyntheticCamera camera(options, clock);
  EXPECT_EQ(shareOf(camera.movingMask(0)), 0);
  EXPECT_GT(shareOf(camera.movingMask(12)), 0.02) << "the arm";
  options.shot = SyntheticShot::kPan;
  EXPECT_EQ(shareOf(SyntheticCamera(options, clock).movingMask(9)), 0)
      << "what the camera's own motion moves does not count";
}

TEST(SyntheticVisitors, HaveRigidPartsThatStayTogether) {
  const Motion motion(SyntheticShot::kVisitors, 1);
  const auto joint = [](const BodyPoses& bodies, FigurePart part) {
    return glm::dvec3(bodies[bodyOf(1, part)][3]);
  };
  const BodyPoses first = motion.bodies(0);
  for (int frame = 0; frame < 480; ++frame) {
    const double t = frame / 30.0;
    const BodyPoses bodies = motion.bodies(t);
    const BodyPoses next = motion.bodies(t + 1 / 30.0);
    for (Body body = kFirstOfFigures; body < kBodies; ++body) {
      EXPECT_NEAR(glm::determinant(glm::dmat3(bodies[body])), 1, 1e-9);
      if (t + 0.1 > kVisitorsSeconds) continue;
      EXPECT_LT(glm::distance(bodies[body][3], next[body][3]), 0.16) << t;
    }
    for (const auto& [from, to] : {std::pair(FigurePart::kLeftThigh, FigurePart::kLeftShin),
                                   std::pair(FigurePart::kRightShin, FigurePart::kRightFoot),
                                   std::pair(FigurePart::kTrunk, FigurePart::kHead)}) {
      EXPECT_NEAR(glm::distance(joint(bodies, from), joint(bodies, to)),
                  glm::distance(joint(first, from), joint(first, to)), 1e-9);
    }
  }
}

TEST(SyntheticVisitors, SetTheirFeetDownWithoutSliding) {
  // One of the feet stands, or nearly so, while the trunk moves on.
  const Motion motion(SyntheticShot::kVisitors, 1);
  double slid = 0;
  double walked = 0;
  for (int step = 0; step < 150; ++step) {
    const double t = 2 + 0.02 * step;
    const BodyPoses from = motion.bodies(t);
    const BodyPoses to = motion.bodies(t + 0.02);
    const auto moved = [&](FigurePart part) {
      return std::abs(to[bodyOf(0, part)][3].x - from[bodyOf(0, part)][3].x);
    };
    slid += std::min(moved(FigurePart::kLeftFoot), moved(FigurePart::kRightFoot));
    walked += moved(FigurePart::kTrunk);
  }
  EXPECT_GT(walked, 3);
  EXPECT_LT(slid, 0.25 * walked);
}

TEST(SyntheticVisitors, SecondOneStandsForTwoSeconds) {
  const Motion motion(SyntheticShot::kVisitors, 1);
  int standing = 0;
  for (int step = 0; step < 65; ++step) {
    const double t = 8 + 0.1 * step;
    const auto trunk = [&](double at) {
      return glm::dvec3(motion.bodies(at)[bodyOf(1, FigurePart::kTrunk)][3]);
    };
    if (glm::distance(trunk(t), trunk(t + 0.1)) < 1e-6) ++standing;
  }
  EXPECT_GE(standing, 18);
  EXPECT_LE(standing, 22);
}

/// The pixels of a frame that show `body`.
std::vector<glm::dvec2> pixelsOf(const Exposure& exposure, Body body) {
  std::vector<glm::dvec2> pixels;
  for (int y = 0; y < exposure.size().height; ++y) {
    for (int x = 0; x < exposure.size().width; ++x) {
      const auto seen = exposure.visibleAt(workbenchGeometry(), {x + 0.5, y + 0.5});
      if (seen && seen->body == body) pixels.emplace_back(x + 0.5, y + 0.5);
    }
  }
  return pixels;
}

TEST(SyntheticVisitors, FlowOfEachPartIsItsProjectedMotion) {
  SteppedClock clock;
  const SyntheticCamera camera(kVisitors, clock);
  const Motion motion(kVisitors.shot, kVisitors.seed);
  const Exposure exposure(kVisitors.size, motion, kFirstPerson * kVisitors.framePeriod, {});
  const BodyPoses from = motion.bodies(3.2);
  const BodyPoses to = motion.bodies(3.4);
  const CameraView view = exposure.viewAt(0);
  for (const FigurePart part : {FigurePart::kTrunk, FigurePart::kHead, FigurePart::kRightForearm,
                                FigurePart::kRightThigh, FigurePart::kLeftShin}) {
    const Body body = bodyOf(0, part);
    const std::vector<glm::dvec2> pixels = pixelsOf(exposure, body);
    EXPECT_GT(pixels.size(), 10u) << static_cast<int>(part);
    for (const glm::dvec2& pixel : pixels) {
      const auto hit = oracleHit(workbenchGeometry(), view, from, pixel);
      ASSERT_TRUE(hit);
      ASSERT_EQ(hit->body, body);
      const glm::dvec3 later(to[body] * glm::inverse(from[body]) * glm::dvec4(hit->world, 1));
      const auto flow = camera.flow(kFirstPerson, kFirstPerson + 1, pixel);
      EXPECT_LT(glm::distance(pixel + flow.px, *view.project(later)), 1e-6);
    }
  }
  // 0.2 s at 1.15 m/s, seen from 3.3 m.
  const std::vector<glm::dvec2> trunk = pixelsOf(exposure, bodyOf(0, FigurePart::kTrunk));
  const glm::dvec2 px = camera.flow(kFirstPerson, kFirstPerson + 1, trunk[trunk.size() / 2]).px;
  EXPECT_NEAR(px.x, view.intrinsics.fx * 0.23 / 3.2, 1.5);
}

}  // namespace
}  // namespace pleinair::hal::synthetic
