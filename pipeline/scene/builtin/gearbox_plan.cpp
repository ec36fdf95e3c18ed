#include "pipeline/scene/builtin/gearbox_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/scene/builtin/shapes.h"

namespace pleinair::scene {
namespace {

constexpr std::array<double, 2> kCentreDistances{0.0465, 0.0580};
/// Shafts are a little further apart than pitch circles would touch: the backlash.
constexpr double kPlayModules = 0.03;

/// Position of a direction on a gear's pitch, from the centre of one tooth at 0 to the next at 1.
double placeOnPitch(const GearboxGear& gear, double directionRad) {
  return (directionRad - gear.phaseRad) * gear.form.teeth / kTurn;
}

/// A gear to the right of `driver` that meshes with it: a gap faces each tooth. Both move equally
/// at the point of contact, so they stay in mesh.
GearboxGear meshed(const GearboxGear& driver, int teeth) {
  GearboxGear gear{.form = driver.form};
  gear.form.teeth = teeth;
  const double m = driver.form.moduleMetres;
  const double apart = m * (0.5 * (driver.form.teeth + teeth) + kPlayModules);
  gear.centre = driver.centre + glm::dvec2(apart, 0.0);
  // seen from either side the flanks mirror each other: the places add up to half a pitch
  const double place = 0.5 - placeOnPitch(driver, 0.0);
  gear.phaseRad = std::numbers::pi - place * kTurn / teeth;
  gear.radiansPerSecond = -driver.radiansPerSecond * driver.form.teeth / teeth;
  return gear;
}

double moduleOf(const std::array<int, 2>& stage, double distance) {
  return 2.0 * distance / (stage[0] + stage[1]);
}

/// The gears at rest, before the whole is centred.
std::array<GearboxGear, 4> gearsFromInput(const GearboxParameters& parameters) {
  std::array<GearboxGear, 4> gears;
  gears[0].form = {.teeth = parameters.stage1[0],
                   .moduleMetres = moduleOf(parameters.stage1, kCentreDistances[0])};
  gears[0].radiansPerSecond = parameters.inputRevolutions * kTurn / 60.0;
  gears[1] = meshed(gears[0], parameters.stage1[1]);
  gears[2].form = {.teeth = parameters.stage2[0],
                   .moduleMetres = moduleOf(parameters.stage2, kCentreDistances[1])};
  gears[2].centre = gears[1].centre;
  gears[2].radiansPerSecond = gears[1].radiansPerSecond;
  gears[3] = meshed(gears[2], parameters.stage2[1]);
  return gears;
}

double tipOf(const GearboxGear& gear) {
  return gearRadii(gear.form).tipMetres;
}

/// Seat radius: the wanted one, as far as the teeth leave a rim.
double seatOf(const GearboxGear& gear, double wanted) {
  return std::min(wanted, gearRadii(gear.form).rootMetres - 1.2 * gear.form.moduleMetres);
}

}  // namespace

GearboxPlan gearboxPlan(const GearboxParameters& parameters) {
  GearboxPlan plan;
  plan.gears = gearsFromInput(parameters);
  plan.faceWidths = {0.014, 0.012, 0.020, 0.018};
  plan.faceMiddles = {-0.013, -0.013, 0.009, 0.009};
  plan.seats = {seatOf(plan.gears[0], 0.007), 0.010, seatOf(plan.gears[2], 0.010), 0.014};
  plan.shafts = {GearboxPlan::Shaft{.bearingBore = 0.006,
                                    .bearingOuter = 0.015,
                                    .seat = plan.seats[0],
                                    .ballRadius = 0.0027,
                                    .balls = 8},
                 {.bearingBore = 0.0075,
                  .bearingOuter = 0.0175,
                  .seat = plan.seats[1],
                  .ballRadius = 0.0030,
                  .balls = 9},
                 {.bearingBore = 0.010,
                  .bearingOuter = 0.021,
                  .seat = plan.seats[3],
                  .ballRadius = 0.0033,
                  .balls = 10}};
  const double first = plan.gears[0].centre.x - plan.shafts[0].bossRadius() - 0.002;
  const double last = plan.gears[3].centre.x +
                      std::max(tipOf(plan.gears[3]) + 0.005, plan.shafts[2].bossRadius() + 0.002);
  const double tallest = std::max(tipOf(plan.gears[1]), tipOf(plan.gears[3]));
  plan.axisHeight = kFloor + 0.008 + tallest;
  for (GearboxGear& gear : plan.gears) {
    gear.centre += glm::dvec2(-0.5 * (first + last), plan.axisHeight);
  }
  plan.left = -0.5 * (last - first);
  plan.right = -plan.left;
  plan.length = 2.0 * (plan.right + kWall + kFootLength);
  const std::array<std::size_t, 3> gearOnShaft{0, 1, 3};
  for (std::size_t i = 0; i < 3; ++i) {
    plan.shafts[i].x = plan.gears[gearOnShaft[i]].centre.x;
    plan.shafts[i].radiansPerSecond = plan.gears[gearOnShaft[i]].radiansPerSecond;
  }
  return plan;
}

std::array<GearboxGear, 4> gearboxGears(const GearboxParameters& parameters) {
  const GearboxPlan plan = gearboxPlan(parameters);
  const double scale = parameters.lengthMetres / plan.length;
  std::array<GearboxGear, 4> gears = plan.gears;
  for (GearboxGear& gear : gears) {
    gear.form.moduleMetres *= scale;
    gear.centre *= scale;
  }
  return gears;
}

}  // namespace pleinair::scene
