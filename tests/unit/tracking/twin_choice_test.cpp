#include "pipeline/tracking/twin_choice.h"

#include <array>

#include <gtest/gtest.h>

#include "tests/support/tag_scene.h"

namespace pleinair::tracking {
namespace {

constexpr double kFreedom = 2.0;

std::array<TwinCandidate, 2> twins(double firstError, double secondError) {
  return {{{.cameraFromTarget = support::poseOf({0.2, 0.0, 0.0}, {0.0, 0.0, 1.0}),
            .squaredErrorPx = firstError},
           {.cameraFromTarget = support::poseOf({-0.2, 0.0, 0.0}, {0.0, 0.0, 1.0}),
            .squaredErrorPx = secondError}}};
}

PosePrior nearSecond(bool isTrusted) {
  return {.cameraFromTarget = support::poseOf({-0.15, 0.02, 0.0}, {0.0, 0.0, 1.0}),
          .isTrusted = isTrusted};
}

TEST(TwinChoice, TakesTheOnlyOne) {
  const auto both = twins(0.1, 0.2);
  const TwinDecision decision = chooseTwin(std::span(both).first(1), kFreedom, nearSecond(true));
  EXPECT_EQ(decision.index, 0U);
  EXPECT_EQ(decision.choice, TwinChoice::kOnly);
}

TEST(TwinChoice, TakesTheClearlyBetterFitAgainstAnyPrior) {
  const TwinDecision decision = chooseTwin(twins(0.1, 20.0), kFreedom, nearSecond(true));
  EXPECT_EQ(decision.index, 0U);
  EXPECT_EQ(decision.choice, TwinChoice::kByError);
}

TEST(TwinChoice, TakesThePriorsWhereTheErrorIsNotClear) {
  const TwinDecision decision = chooseTwin(twins(0.1, 0.2), kFreedom, nearSecond(true));
  EXPECT_EQ(decision.index, 1U);
  EXPECT_EQ(decision.choice, TwinChoice::kByPrior);
}

/// The same difference counts for less where both fit badly.
TEST(TwinChoice, JudgesTheDifferenceByTheResidual) {
  EXPECT_EQ(chooseTwin(twins(0.0, 1.0), kFreedom, std::nullopt).choice, TwinChoice::kByError);
  EXPECT_EQ(chooseTwin(twins(4.0, 5.0), kFreedom, std::nullopt).choice, TwinChoice::kAmbiguous);
}

TEST(TwinChoice, KeepsAGuessAndSaysSo) {
  EXPECT_EQ(chooseTwin(twins(0.1, 0.2), kFreedom, std::nullopt).index, 0U);
  const TwinDecision decision = chooseTwin(twins(0.1, 0.2), kFreedom, nearSecond(false));
  EXPECT_EQ(decision.index, 1U);
  EXPECT_EQ(decision.choice, TwinChoice::kAmbiguous);
}

}  // namespace
}  // namespace pleinair::tracking
