#include "pipeline/overlay/pose_trust.h"

#include <chrono>

#include <gtest/gtest.h>

#include "pipeline/tracking/pose/twist.h"
#include "tests/unit/overlay/overlay_views.h"

namespace pleinair::overlay {
namespace {

using namespace std::chrono_literals;

constexpr PoseEvidence kGood{.hasPose = true, .isSeen = true, .errorPx = 0.2, .partPx = 50.0};

class PoseTrustTest : public testing::Test {
 protected:
  Trust after(hal::Duration time, const PoseEvidence& evidence) {
    now_ += time;
    return trust_.update(evidence, now_);
  }
  /// As often as frames come.
  Trust during(hal::Duration time, const PoseEvidence& evidence) {
    Trust last;
    for (hal::Duration t{0}; t < time; t += 33ms) last = after(33ms, evidence);
    return last;
  }

  PoseTrust trust_;
  hal::TimePoint now_;
};

TEST_F(PoseTrustTest, BeginsWithWhatIsSure) {
  EXPECT_EQ(after(0ms, kGood).opacity, 1.0F);
  EXPECT_FALSE(after(33ms, kGood).standsIn);
}

TEST_F(PoseTrustTest, WithoutAPoseTheInsetStandsIn) {
  const Trust trust = after(0ms, {});
  EXPECT_EQ(trust.opacity, 0.0F);
  EXPECT_TRUE(trust.standsIn);
  EXPECT_EQ(trust.doubt, Doubt::kNotSeen);
}

TEST_F(PoseTrustTest, GoesAtOnceAndComesBackSlowly) {
  during(500ms, kGood);
  EXPECT_EQ(after(33ms, {}).opacity, 0.0F);
  const float first = after(33ms, kGood).opacity;
  EXPECT_GT(first, 0.0F);
  EXPECT_LT(first, 0.4F);
  EXPECT_EQ(during(300ms, kGood).opacity, 1.0F);
}

TEST_F(PoseTrustTest, ALostFrameBringsNoInset) {
  during(500ms, kGood);
  EXPECT_FALSE(after(33ms, {}).standsIn);
  EXPECT_FALSE(during(300ms, kGood).standsIn);
  EXPECT_TRUE(during(500ms, {}).standsIn);
}

TEST_F(PoseTrustTest, AnErrorBeyondItsLimitHides) {
  PoseEvidence evidence = kGood;
  evidence.errorPx = 3.0;
  EXPECT_EQ(after(0ms, evidence).opacity, 0.0F);
  EXPECT_EQ(after(33ms, evidence).doubt, Doubt::kUncertain);
  evidence.pxScale = 3.0;  // of a picture three times as large
  evidence.partPx = 150.0;
  EXPECT_GT(during(500ms, evidence).opacity, 0.9F);
}

TEST_F(PoseTrustTest, ASmallPartAsksForMore) {
  PoseEvidence evidence = kGood;
  evidence.errorPx = 1.0;
  EXPECT_GT(after(0ms, evidence).opacity, 0.0F);
  evidence.partPx = 4.0;
  EXPECT_EQ(after(33ms, evidence).opacity, 0.0F);
}

TEST_F(PoseTrustTest, APoseIsCarriedForAShortTimeOnly) {
  during(500ms, kGood);
  PoseEvidence carried = kGood;
  carried.isSeen = false;
  EXPECT_EQ(during(400ms, carried).opacity, 1.0F);
  const Trust late = during(200ms, carried);
  EXPECT_EQ(late.opacity, 0.0F);
  EXPECT_EQ(late.doubt, Doubt::kCarried);
}

TEST_F(PoseTrustTest, AnotherMachinesTagHidesAtOnceUnlessThisOneIsSeen) {
  PoseEvidence both = kGood;
  both.seesOtherMachine = true;
  EXPECT_EQ(after(0ms, both).opacity, 1.0F) << "two machines in view";
  both.isSeen = false;
  const Trust other = after(33ms, both);
  EXPECT_EQ(other.opacity, 0.0F);
  EXPECT_EQ(other.doubt, Doubt::kOtherMachine);
}

TEST(PredictedError, GrowsWithTheLeverArm) {
  const tracking::CameraModel camera = testCamera();
  const glm::dvec3 origin(0.0, 0.0, 0.5);
  const tracking::PoseCovariance covariance = tracking::isotropic(0.01, 0.0);
  EXPECT_NEAR(predictedErrorPx(camera, covariance, origin, origin), 0.0, 1e-9);
  // A turn of 0.01 rad about each axis, 0.1 m away across the line of sight.
  const double away = predictedErrorPx(camera, covariance, origin, origin + glm::dvec3(0.1, 0, 0));
  EXPECT_NEAR(away, 560.0 * 0.1 * 0.01 / 0.5, 0.1 * away + 0.05);
  EXPECT_GT(predictedErrorPx(camera, covariance, origin, origin + glm::dvec3(0.2, 0, 0)),
            1.8 * away);
}

TEST(PredictedError, OfAShiftIsItsProjection) {
  const glm::dvec3 point(0.0, 0.0, 0.5);
  const double px = predictedErrorPx(testCamera(), tracking::isotropic(0.0, 0.001), point, point);
  EXPECT_NEAR(px, std::sqrt(2.0) * 560.0 * 0.001 / 0.5, 1e-6);
}

}  // namespace
}  // namespace pleinair::overlay
