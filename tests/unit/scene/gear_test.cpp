#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/scene/builtin/builtin_gear.h"
#include "tests/unit/scene/solid_checks.h"

namespace pleinair::scene {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;

double involute(double angle) {
  return std::tan(angle) - angle;
}

/// Angles at which a closed outline crosses the circle about the origin, sorted, in [0, 2π).
std::vector<double> crossings(const std::vector<glm::dvec2>& outline, double radius) {
  std::vector<double> angles;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2& a = outline[i];
    const glm::dvec2& b = outline[(i + 1) % outline.size()];
    const double fromA = glm::length(a) - radius;
    const double fromB = glm::length(b) - radius;
    if ((fromA < 0.0) == (fromB < 0.0)) continue;
    const glm::dvec2 p = a + (b - a) * (fromA / (fromA - fromB));
    angles.push_back(std::fmod(std::atan2(p.y, p.x) + 2.0 * kPi, 2.0 * kPi));
  }
  std::ranges::sort(angles);
  return angles;
}

class GearProfileOf : public testing::TestWithParam<ToothForm> {};

TEST_P(GearProfileOf, HasItsTeethHalfAPitchThickOnThePitchCircle) {
  const ToothForm form = GetParam();
  const GearProfile profile = gearProfile(form);
  const GearRadii radii = gearRadii(form);
  const std::vector<double> angles = crossings(profile.points, radii.pitchMetres);
  ASSERT_EQ(angles.size(), static_cast<std::size_t>(2 * form.teeth));
  // tooth 0 is about angle 0, so the first crossing ends it
  for (std::size_t i = 1; i < angles.size(); i += 2) {
    const double end = i + 1 < angles.size() ? angles[i + 1] : angles[0] + 2.0 * kPi;
    EXPECT_NEAR((end - angles[i]) * radii.pitchMetres, kPi * form.moduleMetres / 2.0,
                0.004 * form.moduleMetres);
  }
}

TEST_P(GearProfileOf, FollowsTheInvoluteAboveTheClearance) {
  const ToothForm form = GetParam();
  const GearProfile profile = gearProfile(form);
  const double pitch = 0.5 * form.teeth * form.moduleMetres;
  const double base = pitch * std::cos(form.pressureAngleRad);
  int onFlanks = 0;
  for (std::size_t i = 0; i < profile.toothPoints; ++i) {
    const glm::dvec2 p = profile.points[i];
    const double radius = glm::length(p);
    const double tip = gearRadii(form).tipMetres;
    if (radius < std::max(base, pitch - form.moduleMetres) || radius > tip - 1e-9) continue;
    const double half = kPi / (2.0 * form.teeth) + involute(form.pressureAngleRad) -
                        involute(std::acos(base / radius));
    EXPECT_NEAR(std::abs(std::atan2(p.y, p.x)), half, 1e-12);
    ++onFlanks;
  }
  EXPECT_GE(onFlanks, 6);
}

INSTANTIATE_TEST_SUITE_P(
    Gears, GearProfileOf,
    testing::Values(ToothForm{.teeth = 18, .moduleMetres = 0.005},
                    ToothForm{.teeth = 6, .moduleMetres = 0.01},
                    ToothForm{.teeth = 11, .moduleMetres = 1.0, .pressureAngleRad = 25.0 * kDegree},
                    ToothForm{
                        .teeth = 60, .moduleMetres = 0.001, .pressureAngleRad = 14.5 * kDegree},
                    ToothForm{.teeth = 200, .moduleMetres = 0.002}));

TEST(GearRadii, AreThoseOfTheBasicRack) {
  const GearRadii radii =
      gearRadii({.teeth = 20, .moduleMetres = 0.002, .pressureAngleRad = 20.0 * kDegree});
  EXPECT_DOUBLE_EQ(radii.pitchMetres, 0.02);
  EXPECT_DOUBLE_EQ(radii.tipMetres, 0.022);
  EXPECT_DOUBLE_EQ(radii.rootMetres, 0.0175);
  EXPECT_NEAR(radii.baseMetres, 0.018793852, 1e-9);
}

TEST(GearRadii, TruncatesATipThatWouldBeAKnife) {
  const ToothForm form{.teeth = 6, .moduleMetres = 1.0, .pressureAngleRad = 25.0 * kDegree};
  const GearRadii radii = gearRadii(form);
  EXPECT_LT(radii.tipMetres, 4.0);
  EXPECT_GE(2.0 * radii.tipMetres * halfToothAngleRad(form, radii.tipMetres), 0.299);
}

class GearMeshOf : public testing::TestWithParam<GearParameters> {};

TEST_P(GearMeshOf, IsAClosedSolidThatFacesOutward) {
  const Mesh mesh = gearMesh(GetParam());
  EXPECT_EQ(unmatchedEdges(mesh), 0);
  EXPECT_GT(volumeOf(mesh), 0.0);
  EXPECT_EQ(wrongNormals(mesh, 0.8), 0);
}

INSTANTIATE_TEST_SUITE_P(
    Gears, GearMeshOf,
    testing::Values(GearParameters{}, GearParameters{.form = {.teeth = 6}},
                    GearParameters{.holes = 1}, GearParameters{.holes = 4},

                    GearParameters{.form = {.teeth = 7}, .thicknessMetres = 0.2},
                    GearParameters{.form = {.teeth = 12, .pressureAngleRad = 25.0 * kDegree}},
                    GearParameters{.form = {.teeth = 40, .moduleMetres = 0.002}, .holes = 8},
                    GearParameters{.form = {.teeth = 200, .moduleMetres = 0.01}, .holes = 6},
                    GearParameters{.form = {.teeth = 30}, .boreDiameterMetres = 0.002},
                    GearParameters{.form = {.teeth = 30}, .hubDiameterMetres = 0.04, .holes = 0}));

TEST(GearMesh, HasTheVolumeOfItsToothFormula) {
  // without a recess: 8 teeth leave no room for one
  GearParameters gear{.form = {.teeth = 8, .moduleMetres = 0.01}, .thicknessMetres = 0.05};
  gear.boreDiameterMetres = 0.02;
  const GearRadii radii = gearRadii(gear.form);
  double area = kPi * (radii.rootMetres * radii.rootMetres - 0.01 * 0.01);
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) {
    const double height = (radii.tipMetres - radii.rootMetres) / kSteps;
    const double radius = radii.rootMetres + (i + 0.5) * height;
    area += 8 * 2.0 * radius * halfToothAngleRad(gear.form, radius) * height;
  }
  // fillets add and chamfers take away within 2 %
  EXPECT_NEAR(volumeOf(gearMesh(gear)), area * 0.05, 0.02 * area * 0.05);
  EXPECT_EQ(eulerCharacteristic(gearMesh(gear)), 0);  // one handle: the bore
}

TEST(GearMesh, HasABoreAndFiveHolesByDefault) {
  EXPECT_EQ(eulerCharacteristic(gearMesh({})), 2 - 2 * 6);
}

TEST(GearMesh, LiesOnItsPlane) {
  const Mesh mesh = gearMesh({});
  float low = 1.0F;
  float high = -1.0F;
  float far = 0.0F;
  for (const MeshVertex& vertex : mesh.vertices) {
    low = std::min(low, vertex.position.z);
    high = std::max(high, vertex.position.z);
    far = std::max(far, std::hypot(vertex.position.x, vertex.position.y));
  }
  EXPECT_EQ(low, 0.0F);
  EXPECT_FLOAT_EQ(high, 0.015F);
  EXPECT_NEAR(far, 0.05, 1e-6);
}

TEST(GearFault, NamesWhatDoesNotFit) {
  const auto bore = faultOf({.boreDiameterMetres = 0.09});
  ASSERT_TRUE(bore);
  EXPECT_EQ(bore->key, "bore_diameter_m");
  EXPECT_EQ(bore->problem, "found 0.09, too wide for the teeth");
  EXPECT_EQ(bore->allowed, "at most 0.07 here");
  const auto hub = faultOf({.boreDiameterMetres = 0.02, .hubDiameterMetres = 0.01});
  ASSERT_TRUE(hub);
  EXPECT_EQ(hub->key, "hub_diameter_m");
  const auto holes = faultOf({.holes = 20});
  ASSERT_TRUE(holes);
  EXPECT_EQ(holes->problem, "found 20, which do not fit into the web");
  EXPECT_FALSE(faultOf({}));
}

}  // namespace
}  // namespace pleinair::scene
