#include "hal/cameras/synthetic/render/motion.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace pleinair::hal::synthetic {
namespace {

struct Placed {
  glm::dvec3 eye;
  glm::dvec3 forward;
};

Placed placed(const glm::dmat4& cameraFromWorld) {
  const glm::dmat4 worldFromCamera = glm::inverse(cameraFromWorld);
  return {glm::dvec3(worldFromCamera[3]), glm::dvec3(worldFromCamera[2])};
}

constexpr double kFrame = 1 / 30.0;

TEST(Motion, IsRigidAndStaysInTheRoomAboveTheBench) {
  for (int shot = 0; shot <= static_cast<int>(SyntheticShot::kCut); ++shot) {
    for (std::uint64_t seed = 1; seed < 4; ++seed) {
      const Motion motion(static_cast<SyntheticShot>(shot), seed);
      for (int t = 0; t < 60; ++t) {
        const glm::dmat4 cameraFromWorld = motion.cameraFromWorld(0.997 * t);
        EXPECT_NEAR(glm::determinant(glm::dmat3(cameraFromWorld)), 1, 1e-12);
        const Placed at = placed(cameraFromWorld);
        EXPECT_GT(at.eye.z, 0.25);
        EXPECT_LT(at.eye.z, 1.0);
        EXPECT_LT(at.eye.y, -0.5) << "before the bench";
        EXPECT_GT(at.eye.y, -1.9);
        EXPECT_GT(at.forward.y, 0.4) << "towards the wall";
        EXPECT_LT(at.forward.z, 0) << "downwards";
      }
    }
  }
}

TEST(Motion, OfAHandIsSmoothButNeverRests) {
  for (const SyntheticShot shot : {SyntheticShot::kWalkaround, SyntheticShot::kOccluder}) {
    const Motion motion(shot, 1);
    for (int frame = 0; frame < 600; ++frame) {
      const Placed before = placed(motion.cameraFromWorld(kFrame * frame));
      const Placed after = placed(motion.cameraFromWorld(kFrame * (frame + 1)));
      const double step = glm::distance(before.eye, after.eye);
      EXPECT_GT(step, 1e-5);
      EXPECT_LT(step, 0.03);
      EXPECT_LT(glm::degrees(glm::distance(before.forward, after.forward)), 1.5);
    }
  }
}

TEST(Motion, IsWhatTheShotsNameSays) {
  const auto at = [](SyntheticShot shot, double t) {
    return placed(Motion(shot, 1).cameraFromWorld(t));
  };
  EXPECT_EQ(Motion(SyntheticShot::kStill, 1).cameraFromWorld(0),
            Motion(SyntheticShot::kStill, 1).cameraFromWorld(17.3));
  for (const SyntheticShot shot :
       {SyntheticShot::kVisitors, SyntheticShot::kCrossing, SyntheticShot::kLights}) {
    EXPECT_EQ(Motion(shot, 1).cameraFromWorld(0), Motion(shot, 2).cameraFromWorld(17.3));
  }
  const Placed start = at(SyntheticShot::kPan, 0);
  const Placed later = at(SyntheticShot::kPan, 1.5);
  EXPECT_LT(glm::distance(start.eye, later.eye), 1e-9) << "a tripod stands";
  EXPECT_GT(glm::distance(start.forward, later.forward), 0.2);
  const Placed railStart = at(SyntheticShot::kDolly, 0);
  const Placed railLater = at(SyntheticShot::kDolly, 2);
  EXPECT_LT(glm::distance(railStart.forward, railLater.forward), 1e-9);
  EXPECT_GT(glm::distance(railStart.eye, railLater.eye), 0.3);
  EXPECT_LT(glm::length(glm::cross(railLater.eye - railStart.eye, railStart.forward)), 1e-9)
      << "along the axis";
  const Placed rollStart = at(SyntheticShot::kRoll, 0);
  const Placed rollLater = at(SyntheticShot::kRoll, 1.5);
  EXPECT_LT(glm::distance(rollStart.forward, rollLater.forward), 1e-9);
  EXPECT_LT(glm::distance(rollStart.eye, rollLater.eye), 1e-9);
}

TEST(Motion, CutsEveryTwoSecondsAndNowhereElse) {
  const Motion motion(SyntheticShot::kCut, 1);
  for (int frame = 0; frame < 300; ++frame) {
    const double jump = glm::distance(placed(motion.cameraFromWorld(kFrame * (frame + 0.5))).eye,
                                      placed(motion.cameraFromWorld(kFrame * (frame + 1.5))).eye);
    if (frame % 60 == 59) {
      EXPECT_GT(jump, 0.3) << frame;
    } else {
      EXPECT_LT(jump, 0.02) << frame;
    }
  }
}

TEST(Motion, MovesTheArmSmoothlyAndOnlyInItsShot) {
  const Motion motion(SyntheticShot::kOccluder, 1);
  double travelled = 0;
  for (int frame = 0; frame < 400; ++frame) {
    const glm::dvec3 from(motion.bodies(kFrame * frame)[kArm][3]);
    const glm::dvec3 to(motion.bodies(kFrame * (frame + 1))[kArm][3]);
    EXPECT_LT(glm::distance(from, to), 0.06) << frame;
    travelled += glm::distance(from, to);
  }
  EXPECT_GT(travelled, 2);
  EXPECT_FALSE(Motion(SyntheticShot::kWalkaround, 1).bodies(2.5).has(kArm));
}

}  // namespace
}  // namespace pleinair::hal::synthetic
