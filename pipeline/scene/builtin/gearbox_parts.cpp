#include "pipeline/scene/builtin/gearbox_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/ext/matrix_transform.hpp>

#include "pipeline/scene/builtin/shapes.h"

namespace pleinair::scene {
namespace {

constexpr double kBevel = 0.0012;
constexpr double kFlangeDepth = 0.010;
constexpr double kRibWidth = 0.005;
constexpr double kPi = std::numbers::pi;

/// The parts of the flange along a long side, between the bearings' bosses.
std::vector<std::array<double, 2>> flangeStretches(const GearboxPlan& plan) {
  constexpr double kMinLength = 0.006;
  std::vector<std::array<double, 2>> stretches;
  double from = plan.left - kWall - kFlangeDepth;
  for (const GearboxPlan::Shaft& shaft : plan.shafts) {
    const double to = shaft.x - shaft.bossRadius();
    if (to - from > kMinLength) stretches.push_back({from, to});
    from = shaft.x + shaft.bossRadius();
  }
  const double end = plan.right + kWall + kFlangeDepth;
  if (end - from > kMinLength) stretches.push_back({from, end});
  return stretches;
}

/// The half of a bearing's seat that protrudes from a wall, from y = `from` to `to`.
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

/// The part that the lower and the upper half have in common, open at the top.
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
  constexpr double kGasket = 0.0004;  // gap that keeps faces from coinciding
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

namespace {

constexpr std::size_t kSegments = 28;
constexpr std::size_t kBearingSegments = 20;
constexpr double kChamfer = 0.0006;
constexpr double kKeyWidth = 0.005;
constexpr double kKeySink = 0.003;
constexpr double kOutputEnd = 0.0095;  // radius
constexpr double kOutputKeyFrom = 0.046;
constexpr double kOutputKeyTo = 0.074;

/// A section of a shaft: its radius from the previous z up to this one.
struct Step {
  double radius;
  double to;
};

/// A stepped shaft from z = `from` up, chamfered at both ends.
Mesh stepped(double from, std::initializer_list<Step> steps) {
  std::vector<glm::dvec2> section{{0.0, from}};
  double z = from;
  for (const Step& step : steps) {
    const bool isFirst = z == from;
    const bool isLast = &step == steps.end() - 1;
    if (isFirst) section.emplace_back(step.radius - kChamfer, z);
    section.emplace_back(step.radius, isFirst ? z + kChamfer : z);
    section.emplace_back(step.radius, isLast ? step.to - kChamfer : step.to);
    if (isLast) section.emplace_back(step.radius - kChamfer, step.to);
    z = step.to;
  }
  section.emplace_back(0.0, z);
  return turned(section, false, kSegments);
}

/// A circle with a keyway at the top (+y).
std::vector<glm::dvec2> keyedCircle(double radius) {
  const double half = std::asin(0.5 * kKeyWidth / radius);
  std::vector<glm::dvec2> outline;
  for (std::size_t i = 0; i <= kSegments; ++i) {
    const double angle =
        0.25 * kTurn + half + (kTurn - 2.0 * half) * static_cast<double>(i) / kSegments;
    outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  // narrower at its bottom, so that all of it is seen from the axis
  const double bottom = 0.48 * kKeyWidth * (radius - kKeySink) / radius;
  outline.emplace_back(bottom, radius - kKeySink);
  outline.emplace_back(-bottom, radius - kKeySink);
  return outline;
}

double bearingMiddleRadius(const GearboxPlan::Shaft& shaft) {
  return 0.5 * (shaft.bearingBore + shaft.bearingOuter);
}

constexpr double kHalfBearing = 0.5 * (kBearingFar - kBearingNear);

/// The groove that a ball runs in, as points of a section from z = −width to width (radius first).
/// `side` 1: in an inner race, as seen from outside; −1: in an outer one.
std::vector<glm::dvec2> groove(const GearboxPlan::Shaft& shaft, double side) {
  constexpr int kPoints = 4;
  const double middle = bearingMiddleRadius(shaft);
  const double deep = 1.04 * shaft.ballRadius;
  const double reach = 0.75;  // part of the ball's angle on either side
  std::vector<glm::dvec2> points;
  for (int i = 0; i <= kPoints; ++i) {
    const double angle = reach * (2.0 * i / kPoints - 1.0);
    points.emplace_back(middle - side * deep * std::cos(angle), deep * std::sin(angle));
  }
  return points;
}

}  // namespace

Mesh inputShaftMesh(const GearboxPlan& plan) {
  const double seat = plan.shafts[0].seat;
  const double bore = plan.shafts[0].bearingBore;
  return stepped(-0.0405, {{bore, -kBearingNear},
                           {bore + 0.002, 0.004},
                           {seat + 0.0015, 0.006},
                           {seat, 0.0205},
                           {bore + 0.002, kBearingNear},
                           {bore, 0.044},
                           {bore - 0.0007, kCouplingFace + 0.0035}});
}

Mesh intermediateShaftMesh(const GearboxPlan& plan) {
  const double bore = plan.shafts[1].bearingBore;
  return stepped(-0.0405, {{bore, -kBearingNear},
                           {bore + 0.0014, -0.0195},
                           {plan.seats[2], 0.0015},
                           {0.0125, 0.0065},
                           {plan.seats[1], 0.0195},
                           {bore + 0.0014, kBearingNear},
                           {bore, 0.0405}});
}

Mesh outputShaftMesh(const GearboxPlan& plan) {
  const double bore = plan.shafts[2].bearingBore;
  Mesh shaft = stepped(-kOutputKeyFrom, {{bore, -kBearingNear},
                                         {bore + 0.0022, -0.0185},
                                         {plan.seats[3], 0.0005},
                                         {0.016, 0.0065},
                                         {bore + 0.0022, kBearingNear},
                                         {bore, 0.0405}});
  const std::vector<glm::dvec2> end = keyedCircle(kOutputEnd);
  append(shaft, prism(end, -kOutputKeyTo, -kOutputKeyFrom));
  append(shaft, stepped(-kOutputKeyTo - 0.004, {{kOutputEnd, -kOutputKeyTo}}));
  return shaft;
}

Mesh outputKeyMesh() {
  const double top = kOutputEnd + 0.002;
  return bevelledBox({-0.49 * kKeyWidth, kOutputEnd - kKeySink, -kOutputKeyTo + 0.0005},
                     {0.49 * kKeyWidth, top, -kOutputKeyFrom - 0.0005}, 0.0004);
}

Mesh couplingMesh() {
  const std::array<glm::dvec2, 10> section{{{0.0, 0.046},
                                            {0.0095, 0.046},
                                            {0.0105, 0.047},
                                            {0.0105, 0.0615},
                                            {0.0115, 0.0630},
                                            {0.0200, 0.0630},
                                            {0.0208, 0.0638},
                                            {0.0208, kCouplingFace - 0.0008},
                                            {0.0200, kCouplingFace},
                                            {0.0, kCouplingFace}}};
  return turned(section, false, kSegments);
}

Mesh outerRaceMesh(const GearboxPlan::Shaft& shaft) {
  const double lip = bearingMiddleRadius(shaft) + 0.55 * shaft.ballRadius;
  const double outer = shaft.bearingOuter - 0.0001;  // clear of its seat
  std::vector<glm::dvec2> section{{lip, kHalfBearing}};
  for (auto groovePoints = groove(shaft, -1.0); !groovePoints.empty(); groovePoints.pop_back()) {
    section.push_back(groovePoints.back());
  }
  section.insert(section.end(), {{lip, -kHalfBearing},
                                 {outer - kChamfer, -kHalfBearing},
                                 {outer, -kHalfBearing + kChamfer},
                                 {outer, kHalfBearing - kChamfer},
                                 {outer - kChamfer, kHalfBearing}});
  return turned(section, true, kBearingSegments);
}

Mesh innerRaceMesh(const GearboxPlan::Shaft& shaft) {
  const double lip = bearingMiddleRadius(shaft) - 0.55 * shaft.ballRadius;
  const double bore = shaft.bearingBore;
  std::vector<glm::dvec2> section{
      {bore, kHalfBearing}, {bore, -kHalfBearing}, {lip, -kHalfBearing}};
  for (const glm::dvec2& p : groove(shaft, 1.0)) section.push_back(p);
  section.emplace_back(lip, kHalfBearing);
  return turned(section, true, kBearingSegments);
}

Mesh ballsMesh(const GearboxPlan::Shaft& shaft) {
  const Mesh ball = sphere(shaft.ballRadius, 8, 5);
  const double radius = bearingMiddleRadius(shaft);
  Mesh balls;
  for (int i = 0; i < shaft.balls; ++i) {
    const double angle = kTurn * i / shaft.balls;
    append(
        balls, ball,
        glm::translate(glm::dmat4(1.0), {radius * std::cos(angle), radius * std::sin(angle), 0.0}));
  }
  return balls;
}

Mesh cageMesh(const GearboxPlan::Shaft& shaft) {
  const double middle = bearingMiddleRadius(shaft);
  const double half = 0.2 * shaft.ballRadius;  // balls protrude on either side of it
  Mesh cage;
  // two rings beside the balls, and a bar between each two balls
  for (const double z : {-1.15 * shaft.ballRadius, 1.15 * shaft.ballRadius}) {
    const double thin = 0.14 * shaft.ballRadius;
    const std::array<glm::dvec2, 4> ring{{{middle - half, z - thin},
                                          {middle + half, z - thin},
                                          {middle + half, z + thin},
                                          {middle - half, z + thin}}};
    append(cage, turned(ring, true, kBearingSegments));
  }
  const double reach = 1.1 * shaft.ballRadius;
  const Mesh bar = bevelledBox({-0.35 * shaft.ballRadius, -1.6 * half, -reach},
                               {0.35 * shaft.ballRadius, 1.6 * half, reach}, 0.0);
  for (int i = 0; i < shaft.balls; ++i) {
    const glm::dmat4 turn =
        glm::rotate(glm::dmat4(1.0), kTurn * (i + 0.5) / shaft.balls, {0.0, 0.0, 1.0});
    append(cage, bar,
           glm::rotate(glm::translate(turn, {middle, 0.0, 0.0}), 0.25 * kTurn, {0.0, 0.0, 1.0}));
  }
  return cage;
}

double cageRatio(const GearboxPlan::Shaft& shaft) {
  return 0.5 * (1.0 - shaft.ballRadius / bearingMiddleRadius(shaft));
}

Mesh endCoverMesh(const GearboxPlan::Shaft& shaft) {
  const double rim = shaft.bossRadius() - 0.0008;
  const double dome = 0.6 * shaft.bearingOuter;
  const std::array<glm::dvec2, 8> section{{{0.0, 0.0},
                                           {rim, 0.0},
                                           {rim, 0.0030},
                                           {rim - 0.0008, 0.0038},
                                           {dome + 0.002, 0.0038},
                                           {dome, 0.0058},
                                           {dome - 0.0008, 0.0064},
                                           {0.0, 0.0064}}};
  return turned(section, false, kSegments);
}

}  // namespace pleinair::scene
