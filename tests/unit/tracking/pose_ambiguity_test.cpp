#include "pipeline/tracking/pose/pose_ambiguity.h"

#include <array>
#include <cmath>

#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace pleinair::tracking {
namespace {

constexpr double kFreedom = 2.0;  // of one tag

glm::dmat4 tilted(double degrees) {
  const double angle = glm::radians(degrees);
  glm::dmat4 pose(1.0);
  pose[1] = {0.0, std::cos(angle), std::sin(angle), 0.0};
  pose[2] = {0.0, -std::sin(angle), std::cos(angle), 0.0};
  pose[3] = {0.0, 0.0, 1.0, 1.0};
  return pose;
}

/// A tag tilted by 20° and its mirror image, with their squared errors (px²).
std::array<PoseCandidate, 2> alternatives(double better, double worse) {
  return {{{tilted(20.0), better}, {tilted(-20.0), worse}}};
}

TEST(AmbiguityResolution, OneCandidateIsTheOnlyOne) {
  const std::array<PoseCandidate, 1> one{{{tilted(20.0), 3.0}}};
  const AmbiguityDecision decision = resolveAmbiguity(one, kFreedom, PosePrior{tilted(-20.0)});
  EXPECT_EQ(decision.index, 0U);
  EXPECT_EQ(decision.choice, AmbiguityResolution::kOnly);
  EXPECT_LT(decision.evidence, kClearEvidence) << "its alternative may be back in the next frame";
}

TEST(AmbiguityResolution, AClearErrorOutweighsAnyPrior) {
  const AmbiguityDecision decision =
      resolveAmbiguity(alternatives(0.01, 2.0), kFreedom, PosePrior{tilted(-20.0), kFullEvidence});
  EXPECT_EQ(decision.index, 0U);
  EXPECT_EQ(decision.choice, AmbiguityResolution::kByError);
}

TEST(AmbiguityResolution, TheSameDifferenceIsNotClearAmongLargeErrors) {
  const AmbiguityDecision decision =
      resolveAmbiguity(alternatives(10.0, 12.0), kFreedom, std::nullopt);
  EXPECT_EQ(decision.index, 0U);
  EXPECT_EQ(decision.choice, AmbiguityResolution::kAmbiguous);
}

TEST(AmbiguityResolution, ASurePriorDecidesWhatErrorsCannot) {
  const AmbiguityDecision decision =
      resolveAmbiguity(alternatives(0.01, 0.2), kFreedom, PosePrior{tilted(-17.0)});
  EXPECT_EQ(decision.index, 1U);
  EXPECT_EQ(decision.choice, AmbiguityResolution::kByPrior);
}

TEST(AmbiguityResolution, AWeakPriorGivesWayToErrors) {
  const AmbiguityDecision decision =
      resolveAmbiguity(alternatives(0.01, 0.2), kFreedom, PosePrior{tilted(-17.0), 2.0});
  EXPECT_EQ(decision.index, 0U);
  EXPECT_EQ(decision.choice, AmbiguityResolution::kAmbiguous);
}

TEST(AmbiguityResolution, FramesThatAgreeBecomeClear) {
  AmbiguityDecision decision = resolveAmbiguity(alternatives(0.01, 0.3), kFreedom, std::nullopt);
  EXPECT_EQ(decision.choice, AmbiguityResolution::kAmbiguous);
  for (int frame = 0; frame < 4; ++frame) {
    decision = resolveAmbiguity(alternatives(0.01, 0.3), kFreedom,
                                PosePrior{tilted(20.0), decision.evidence});
    EXPECT_EQ(decision.index, 0U);
  }
  EXPECT_EQ(decision.choice, AmbiguityResolution::kByPrior);
  EXPECT_LE(decision.evidence, kFullEvidence);
}

TEST(AmbiguityResolution, FramesThatContradictUnlearnAMistake) {
  double evidence = kFullEvidence;
  double degrees = -20.0;  // wrong
  int frame = 0;
  for (; frame < 20 && degrees < 0.0; ++frame) {
    const AmbiguityDecision decision =
        resolveAmbiguity(alternatives(0.01, 0.2), kFreedom, PosePrior{tilted(degrees), evidence});
    degrees = decision.index == 0 ? 20.0 : -20.0;
    evidence = decision.evidence;
  }
  EXPECT_GT(frame, 1) << "one frame's noise must not turn a tag over";
  EXPECT_LT(frame, 8);
}

/// With equal errors, no choice may ever become clear.
TEST(AmbiguityResolution, EqualErrorsStayAmbiguous) {
  AmbiguityDecision decision = resolveAmbiguity(alternatives(0.1, 0.1), kFreedom, std::nullopt);
  for (int frame = 0; frame < 100; ++frame) {
    decision = resolveAmbiguity(alternatives(0.1, 0.12), kFreedom,
                                PosePrior{tilted(20.0), decision.evidence});
    ASSERT_EQ(decision.choice, AmbiguityResolution::kAmbiguous);
  }
}

}  // namespace
}  // namespace pleinair::tracking
