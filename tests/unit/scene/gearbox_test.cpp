#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <gmock/gmock.h>

#include "pipeline/scene/builtin/builtin_gearbox.h"
#include "pipeline/scene/builtin/gear_profile.h"
#include "tests/unit/scene/solid_checks.h"

namespace pleinair::scene {
namespace {

using Outline = std::vector<glm::dvec2>;
constexpr double kTurn = 2.0 * std::numbers::pi;

Outline outlineAt(const GearboxGear& gear, double seconds) {
  const double angle = gear.phaseRad + gear.radiansPerSecond * seconds;
  const glm::dvec2 along(std::cos(angle), std::sin(angle));
  Outline outline = gearProfile(gear.form).points;
  for (glm::dvec2& p : outline) {
    p = gear.centre + glm::dvec2(along.x * p.x - along.y * p.y, along.y * p.x + along.x * p.y);
  }
  return outline;
}

bool isInside(const Outline& outline, const glm::dvec2& p) {
  bool isIn = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2& a = outline[i];
    const glm::dvec2& b = outline[(i + 1) % outline.size()];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) {
      isIn = !isIn;
    }
  }
  return isIn;
}

double distanceTo(const Outline& outline, const glm::dvec2& p) {
  double least = 1e9;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2& a = outline[i];
    const glm::dvec2 along = outline[(i + 1) % outline.size()] - a;
    const double t = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0, 1.0);
    least = std::min(least, glm::distance(p, a + t * along));
  }
  return least;
}

/// How two gears stand to each other: whether one is in the other, and how near they come.
struct Contact {
  double deepest = 0.0;
  double gap = 1e9;
};

void look(const Outline& points, const Outline& other, const glm::dvec2& otherCentre, double reach,
          Contact& contact) {
  for (const glm::dvec2& p : points) {
    if (glm::distance(p, otherCentre) > reach) continue;
    const double distance = distanceTo(other, p);
    if (isInside(other, p)) contact.deepest = std::max(contact.deepest, distance);
    contact.gap = std::min(contact.gap, distance);
  }
}

class GearboxTeeth : public testing::TestWithParam<std::array<std::array<int, 2>, 2>> {};

TEST_P(GearboxTeeth, MeshWithoutTouchingEachOthersInsides) {
  const auto& [stage1, stage2] = GetParam();
  const auto gears = gearboxGears({.stage1 = stage1, .stage2 = stage2});
  for (const std::size_t pinion : {std::size_t{0}, std::size_t{2}}) {
    const GearboxGear& a = gears[pinion];
    const GearboxGear& b = gears[pinion + 1];
    const double m = a.form.moduleMetres;
    EXPECT_EQ(m, b.form.moduleMetres);
    const double secondsPerTooth = kTurn / a.form.teeth / std::abs(a.radiansPerSecond);
    constexpr int kSteps = 24;
    for (int i = 0; i < kSteps; ++i) {
      // a tooth's worth, some turns on
      const double seconds = secondsPerTooth * (1000.0 + static_cast<double>(i) / kSteps);
      const Outline outlineA = outlineAt(a, seconds);
      const Outline outlineB = outlineAt(b, seconds);
      Contact contact;
      look(outlineA, outlineB, b.centre, gearRadii(b.form).tipMetres + 0.5 * m, contact);
      look(outlineB, outlineA, a.centre, gearRadii(a.form).tipMetres + 0.5 * m, contact);
      EXPECT_EQ(contact.deepest, 0.0) << "gear " << pinion << ", step " << i;
      EXPECT_LT(contact.gap, 0.05 * m) << "gear " << pinion << ", step " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Stages, GearboxTeeth,
                         testing::Values(std::array{std::array{19, 43}, std::array{18, 40}},
                                         std::array{std::array{30, 36}, std::array{24, 57}},
                                         std::array{std::array{17, 60}, std::array{21, 44}}));

TEST(GearboxGears, TurnAtTheRatioOfTheirTeeth) {
  const auto gears = gearboxGears({.inputRevolutions = 60.0});
  EXPECT_DOUBLE_EQ(gears[0].radiansPerSecond, kTurn);
  EXPECT_DOUBLE_EQ(gears[1].radiansPerSecond, -kTurn * 19 / 43);
  EXPECT_DOUBLE_EQ(gears[2].radiansPerSecond, gears[1].radiansPerSecond);
  EXPECT_DOUBLE_EQ(gears[3].radiansPerSecond, kTurn * 19 / 43 * 18 / 40);
}

/// Where a part's own point is after a while.
glm::dvec3 placed(const ModelPart& part, const glm::dvec3& p, hal::Duration time) {
  return glm::dvec3(modelFromPart(part, time) * glm::dvec4(p, 1.0));
}

TEST(GearboxModel, TurnsItsGearsAsTheirTeethSay) {
  const GearboxParameters parameters{.lengthMetres = 0.4, .inputRevolutions = 33.0};
  const Model model = gearboxModel(parameters);
  const auto gears = gearboxGears(parameters);
  for (std::size_t i = 0; i < 4; ++i) {
    const ModelPart* part = findPart(model, "gear_" + std::to_string(i + 1));
    ASSERT_NE(part, nullptr);
    for (const hal::Duration time : {hal::Duration(0), hal::Duration(1'234'567'890)}) {
      const double seconds = 1e-9 * static_cast<double>(time.count());
      const double angle = gears[i].phaseRad + gears[i].radiansPerSecond * seconds;
      const glm::dvec3 middle = placed(*part, {0, 0, 0}, time);
      const glm::dvec3 tooth = placed(*part, {0.01, 0, 0}, time) - middle;
      EXPECT_NEAR(middle.x, gears[i].centre.x, 1e-12);
      EXPECT_NEAR(middle.z, gears[i].centre.y, 1e-12);
      // seen by the reader, who looks along y, x goes to the right and z up
      EXPECT_NEAR(std::remainder(std::atan2(tooth.z, tooth.x) - angle, kTurn), 0.0, 1e-9);
      EXPECT_NEAR(tooth.y, 0.0, 1e-12);
    }
  }
}

TEST(GearboxModel, TurnsWhatIsOnAShaftTogether) {
  const Model model = gearboxModel({});
  const auto rateOf = [&](const char* name) {
    const ModelPart* part = findPart(model, name);
    return part == nullptr ? std::nan("") : part->radiansPerSecond;
  };
  EXPECT_EQ(rateOf("housing"), 0.0);
  EXPECT_EQ(rateOf("bearing_1_outer_race"), 0.0);
  for (const char* name : {"input_shaft", "input_coupling", "coupling_bolts",
                           "bearing_1_inner_race", "bearing_2_inner_race"}) {
    EXPECT_EQ(rateOf(name), rateOf("gear_1")) << name;
  }
  EXPECT_EQ(rateOf("intermediate_shaft"), rateOf("gear_2"));
  EXPECT_EQ(rateOf("gear_3"), rateOf("gear_2"));
  EXPECT_EQ(rateOf("output_shaft"), rateOf("gear_4"));
  EXPECT_EQ(rateOf("output_key"), rateOf("gear_4"));
  // balls roll: they go round at less than half their shaft's speed
  EXPECT_GT(rateOf("bearing_1_balls"), 0.3 * rateOf("gear_1"));
  EXPECT_LT(rateOf("bearing_1_balls"), 0.5 * rateOf("gear_1"));
}

class Gearboxes : public testing::TestWithParam<GearboxParameters> {};

TEST_P(Gearboxes, AreOfSoundSurfaces) {
  const Model model = gearboxModel(GetParam());
  EXPECT_GT(model.triangleCount(), 20'000u);
  EXPECT_LT(model.triangleCount(), GetParam() == GearboxParameters{} ? 62'000u : 70'000u)
      << model.triangleCount();
  for (const Surface& surface : model.surfaces) {
    EXPECT_EQ(wrongNormals(surface.mesh, 0.5), 0) << model.materials[surface.material].name;
    EXPECT_GT(volumeOf(surface.mesh), 0.0);
  }
  std::set<std::string> names;
  for (const ModelPart& part : model.parts) {
    EXPECT_TRUE(names.insert(part.name).second) << part.name;
  }
  // single solids are closed
  for (const char* name : {"gear_1", "gear_4", "input_shaft", "intermediate_shaft",
                           "input_coupling", "bearing_3_outer_race", "bearing_3_inner_race",
                           "bearing_3_balls", "end_cover_1", "output_key"}) {
    const ModelPart* part = findPart(model, name);
    ASSERT_NE(part, nullptr) << name;
    EXPECT_EQ(unmatchedEdges(model.surfaces[part->firstSurface].mesh), 0) << name;
  }
}

TEST_P(Gearboxes, StandOnTheirFeetOverTheOrigin) {
  const Model model = gearboxModel(GetParam());
  glm::dvec3 low(1e9);
  glm::dvec3 high(-1e9);
  const ModelPart* housing = findPart(model, "housing");
  for (const MeshVertex& vertex : model.surfaces[housing->firstSurface].mesh.vertices) {
    const glm::dvec3 p = placed(*housing, glm::dvec3(vertex.position), {});
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  EXPECT_NEAR(low.z, 0.0, 1e-9);
  EXPECT_NEAR(high.x - low.x, GetParam().lengthMetres, 1e-6);
  EXPECT_NEAR(high.x + low.x, 0.0, 1e-6);
  EXPECT_NEAR(high.y + low.y, 0.0, 1e-6);
  // gears are within the walls and above the floor
  for (const GearboxGear& gear : gearboxGears(GetParam())) {
    const double tip = gearRadii(gear.form).tipMetres;
    EXPECT_GT(gear.centre.x - tip, low.x);
    EXPECT_LT(gear.centre.x + tip, high.x);
    EXPECT_GT(gear.centre.y - tip, 0.02 * GetParam().lengthMetres);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, Gearboxes,
    testing::Values(GearboxParameters{}, GearboxParameters{.lengthMetres = 2.0, .isClosed = true},
                    GearboxParameters{.lengthMetres = 0.25, .stage1 = {16, 60}, .stage2 = {16, 60}},
                    GearboxParameters{
                        .lengthMetres = 0.25, .stage1 = {30, 36}, .stage2 = {30, 36}}));

TEST(GearboxModel, HasACoverOnlyWhenClosed) {
  EXPECT_EQ(findPart(gearboxModel({}), "cover"), nullptr);
  EXPECT_NE(findPart(gearboxModel({}), "stud_1"), nullptr);
  const Model closed = gearboxModel({.isClosed = true});
  EXPECT_NE(findPart(closed, "cover"), nullptr);
  EXPECT_NE(findPart(closed, "cover_bolt_1"), nullptr);
}

}  // namespace
}  // namespace pleinair::scene
