#include "pipeline/scene/gearbox_parts.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/ext/matrix_transform.hpp>

#include "pipeline/scene/shapes.h"

namespace pleinair::scene {
namespace {

constexpr std::size_t kSegments = 28;
constexpr std::size_t kBearingSegments = 20;
constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kChamfer = 0.0006;
constexpr double kKeyWidth = 0.005;
constexpr double kKeySink = 0.003;
constexpr double kOutputEnd = 0.0095;  // radius
constexpr double kOutputKeyFrom = 0.046;
constexpr double kOutputKeyTo = 0.074;

/// A length of a shaft: its radius from the z before up to this one.
struct Step {
  double radius;
  double to;
};

/// Steps from z = `from` up, chamfered at both ends.
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

/// A circle with a keyway at the top (y).
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

/// A groove that a ball runs in, as points of a section from z = −width to width (radius first).
/// `side` 1: in an inner race, seen from outside; −1: in an outer one.
std::vector<glm::dvec2> groove(const GearboxPlan::Shaft& shaft, double side) {
  constexpr int kPoints = 4;
  const double middle = bearingMiddleRadius(shaft);
  const double deep = 1.04 * shaft.ballRadius;
  const double reach = 0.75;  // of the ball's angle on either side
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
  const double half = 0.2 * shaft.ballRadius;  // balls are seen on either side of it
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
