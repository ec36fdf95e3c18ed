#include "pipeline/inspection/part_inspection.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "tests/unit/inspection/plane_pictures.h"

namespace pleinair::inspection {
namespace {

constexpr double kRadius = 0.05;

class PartInspectionTest : public testing::Test {
 protected:
  Inspection inspect(const glm::dmat4& place, const hal::Image& still,
                     const glm::dvec3& centre = {}) const {
    return inspectPart({template_.view(), camera(), kFront}, {still.view(), camera(), place},
                       {.centre = centre, .radiusMetres = kRadius});
  }
  /// In less light, with a sensor's noise.
  static hal::Image darker(hal::Image image, double gain) {
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0.0, 3.0);
    for (std::uint8_t& each : image.plane(0)) {
      each = static_cast<std::uint8_t>(std::clamp(gain * each + noise(random), 0.0, 255.0));
    }
    return image;
  }

  static inline const glm::dmat4 kFront = lookingFrom(0);
  hal::Image template_ = planeSeen(kFront);
};

TEST_F(PartInspectionTest, TheSameFromNearbyPasses) {
  for (const glm::dmat4& place : {kFront, lookingFrom(9, 15), lookingFrom(-6, 0, 0.6)}) {
    const Inspection result = inspect(place, planeSeen(place));
    EXPECT_EQ(result.verdict, Verdict::kPass) << result.match->mean << ' ' << result.match->worst;
  }
}

TEST_F(PartInspectionTest, SomethingElseFails) {
  hal::Image other = template_;
  std::ranges::transform(other.plane(0), other.plane(0).begin(),
                         [](std::uint8_t each) { return static_cast<std::uint8_t>(255 - each); });
  EXPECT_EQ(inspect(kFront, other).verdict, Verdict::kFail);
}

TEST_F(PartInspectionTest, FromAnotherSideItIsUncertainAndSaysSo) {
  const glm::dmat4 place = lookingFrom(20);
  const Inspection result = inspect(place, planeSeen(place));
  EXPECT_EQ(result.verdict, Verdict::kUncertain);
  EXPECT_EQ(result.reason, Uncertainty::kOtherSide);
  EXPECT_NEAR(result.viewDeg, 20.0, 0.5);
}

TEST_F(PartInspectionTest, FromTooFarOrBesideThePictureItIsUncertain) {
  const glm::dmat4 far = lookingFrom(0, 0, 1.4);
  EXPECT_EQ(inspect(far, planeSeen(far)).reason, Uncertainty::kTooFar);
  EXPECT_EQ(inspect(kFront, template_, {0.18, 0, 0}).reason, Uncertainty::kNotWholly);
}

TEST_F(PartInspectionTest, InLowLightNothingWrongPasses) {
  hal::Image other = template_;
  std::ranges::reverse(other.plane(0));
  for (const double gain : {0.3, 0.1, 0.03, 0.01}) {
    const Inspection wrong = inspect(kFront, darker(other, gain));
    EXPECT_NE(wrong.verdict, Verdict::kPass) << gain;
  }
  EXPECT_EQ(inspect(kFront, darker(template_, 0.3)).verdict, Verdict::kPass);
  EXPECT_EQ(inspect(kFront, darker(template_, 0.03)).reason, Uncertainty::kTooDark);
}

TEST_F(PartInspectionTest, ATemplateThatShowsNothingIsUncertain) {
  template_ = hal::Image({.pixelFormat = hal::PixelFormat::kGrey8, .size = kSize});
  EXPECT_EQ(inspect(kFront, template_).reason, Uncertainty::kNothingToCompare);
}

}  // namespace
}  // namespace pleinair::inspection
