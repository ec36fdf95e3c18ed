#include "pipeline/scene/gearbox_housing.h"

#include <algorithm>
#include <array>
#include <numbers>

#include <glm/ext/matrix_transform.hpp>

#include "pipeline/scene/shapes.h"

namespace pleinair::scene {
namespace {

constexpr double kBevel = 0.0012;
constexpr double kFlangeDepth = 0.010;
constexpr double kRibWidth = 0.005;
constexpr double kPi = std::numbers::pi;

/// The stretches of the flange along a long side, between the bearings' bosses.
std::vector<std::array<double, 2>> flangeStretches(const GearboxPlan& plan) {
  constexpr double kShortest = 0.006;
  std::vector<std::array<double, 2>> stretches;
  double from = plan.left - kWall - kFlangeDepth;
  for (const GearboxPlan::Shaft& shaft : plan.shafts) {
    const double to = shaft.x - shaft.bossRadius();
    if (to - from > kShortest) stretches.push_back({from, to});
    from = shaft.x + shaft.bossRadius();
  }
  const double end = plan.right + kWall + kFlangeDepth;
  if (end - from > kShortest) stretches.push_back({from, end});
  return stretches;
}

/// The half of a bearing's seat that stands out of a wall, from y = `from` to `to`.
Mesh halfBoss(const GearboxPlan::Shaft& shaft, double height, double from, double to) {
  const bool isFront = to < from;
  const double chamfer = isFront ? -kBevel : kBevel;
  const double inner = shaft.bearingOuter;
  const double outer = shaft.bossRadius();
  // turned about z, which then becomes y
  std::vector<glm::dvec2> ring{
      {inner, from}, {outer, from}, {outer, to - chamfer}, {outer - kBevel, to}, {inner, to}};
  if (isFront) std::ranges::reverse(ring);
  const Mesh half = turned(ring, true, 24, {.from = 0.0, .to = kPi});
  // x stays, z becomes y, y becomes −z: the half that y > 0 had hangs down
  const glm::dmat4 lying{1.0, 0.0, 0.0, 0.0, 0.0,     0.0, -1.0,   0.0,
                         0.0, 1.0, 0.0, 0.0, shaft.x, 0.0, height, 1.0};
  Mesh boss;
  append(boss, half, lying);
  return boss;
}

/// What the lower and the upper half have in common; its open side is up.
Mesh tubMesh(const GearboxPlan& plan) {
  const double top = plan.axisHeight;
  const double left = plan.left - kWall;
  const double right = plan.right + kWall;
  std::vector<Notch> seats;
  for (const GearboxPlan::Shaft& shaft : plan.shafts)
    seats.push_back({shaft.x, shaft.bearingOuter});
  Mesh tub;
  append(tub, notchedWall({left, -kHalfOutside, 0.0}, {right, -kHalfInside, top}, seats));
  append(tub, notchedWall({left, kHalfInside, 0.0}, {right, kHalfOutside, top}, seats));
  append(tub, bevelledBox({left, -kHalfInside, 0.0}, {plan.left, kHalfInside, top}, 0.0));
  append(tub, bevelledBox({plan.right, -kHalfInside, 0.0}, {right, kHalfInside, top}, 0.0));
  append(tub, bevelledBox({plan.left, -kHalfInside, 0.0}, {plan.right, kHalfInside, kFloor}, 0.0));
  for (const GearboxPlan::Shaft& shaft : plan.shafts) {
    append(tub, halfBoss(shaft, top, -kHalfOutside, -kHalfBoss));
    append(tub, halfBoss(shaft, top, kHalfOutside, kHalfBoss));
  }
  const double low = top - kFlangeHeight;
  const double reach = kHalfOutside + kFlangeDepth;
  for (const auto& [from, to] : flangeStretches(plan)) {
    append(tub, bevelledBox({from, -reach, low}, {to, -kHalfOutside, top}, kBevel));
    append(tub, bevelledBox({from, kHalfOutside, low}, {to, reach, top}, kBevel));
  }
  append(tub,
         bevelledBox({left - kFlangeDepth, -kHalfOutside, low}, {left, kHalfOutside, top}, kBevel));
  append(tub, bevelledBox({right, -kHalfOutside, low}, {right + kFlangeDepth, kHalfOutside, top},
                          kBevel));
  return tub;
}

void addRibs(Mesh& housing, const GearboxPlan& plan) {
  for (const GearboxPlan::Shaft& shaft : plan.shafts) {
    const double top = plan.axisHeight - shaft.bearingOuter - 0.003;
    const double half = 0.5 * kRibWidth;
    const double reach = kHalfBoss - 0.0015;
    append(housing, bevelledBox({shaft.x - half, -reach, 0.0},
                                {shaft.x + half, -kHalfOutside + 0.001, top}, 0.0006));
    append(housing, bevelledBox({shaft.x - half, kHalfOutside - 0.001, 0.0},
                                {shaft.x + half, reach, top}, 0.0006));
  }
}

void addFeet(Mesh& housing, const GearboxPlan& plan) {
  const double left = plan.left - kWall;
  const double right = plan.right + kWall;
  append(housing, bevelledBox({left - kFootLength, -kHalfOutside, 0.0},
                              {left, kHalfOutside, kFootHeight}, kBevel));
  append(housing, bevelledBox({right, -kHalfOutside, 0.0},
                              {right + kFootLength, kHalfOutside, kFootHeight}, kBevel));
  const Mesh rib =
      gusset(0.8 * kFootLength, plan.axisHeight - kFlangeHeight - kFootHeight - 0.004, kRibWidth);
  // into the foot by a millimetre, so that nothing gapes
  const double down = kFootHeight - 0.001;
  append(housing, rib, glm::translate(glm::dmat4(1.0), {right - 0.0005, 0.0, down}));
  append(housing, rib,
         glm::scale(glm::translate(glm::dmat4(1.0), {left + 0.0005, 0.0, down}), {-1.0, 1.0, 1.0}));
}

}  // namespace

Mesh housingMesh(const GearboxPlan& plan) {
  Mesh housing = tubMesh(plan);
  addRibs(housing, plan);
  addFeet(housing, plan);
  return housing;
}

Mesh coverMesh(const GearboxPlan& plan) {
  constexpr double kGasket = 0.0004;  // apart, so that faces do not lie in each other
  Mesh cover;
  append(cover, tubMesh(plan),
         glm::scale(glm::translate(glm::dmat4(1.0), {0.0, 0.0, 2.0 * plan.axisHeight + kGasket}),
                    {1.0, 1.0, -1.0}));
  return cover;
}

std::vector<glm::dmat4> footBolts(const GearboxPlan& plan) {
  std::vector<glm::dmat4> places;
  const double x = plan.right + kWall + 0.6 * kFootLength;
  for (const double side : {-x, x}) {
    for (const double y : {-0.66 * kHalfOutside, 0.66 * kHalfOutside}) {
      places.push_back(glm::translate(glm::dmat4(1.0), {side, y, kFootHeight}));
    }
  }
  return places;
}

std::vector<glm::dmat4> flangeBolts(const GearboxPlan& plan) {
  std::vector<glm::dmat4> places;
  const auto add = [&](double x, double y) {
    places.push_back(glm::translate(glm::dmat4(1.0), {x, y, plan.axisHeight}));
  };
  const double y = kHalfOutside + 0.5 * kFlangeDepth;
  for (const auto& [from, to] : flangeStretches(plan)) {
    for (const double side : {-y, y}) add(0.5 * (from + to), side);
  }
  const double x = plan.right + kWall + 0.5 * kFlangeDepth;
  for (const double side : {-x, x}) {
    for (const double at : {-0.55 * kHalfOutside, 0.55 * kHalfOutside}) add(side, at);
  }
  return places;
}

}  // namespace pleinair::scene
