#include "tests/oracles/stroke_oracle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace pleinair::oracles {
namespace {

double angleOf(glm::dvec2 unitA, glm::dvec2 unitB) {
  return std::acos(std::clamp(glm::dot(unitA, unitB), -1.0, 1.0));
}

/// The direction's sign that bends least from the heading.
glm::dvec2 onward(glm::dvec2 direction, glm::dvec2 heading) {
  return glm::dot(direction, heading) < 0.0 ? -direction : direction;
}

/// The direction of a step that leans away from the side whose colour differs more.
glm::dvec2 leaned(const StrokeGround& ground, const StrokeWalk& walk, glm::dvec2 at,
                  glm::dvec2 direction, glm::dvec3 colour) {
  constexpr double kReach = 0.45;
  constexpr double kLean = 4.0;
  constexpr double kMost = 0.35;
  const double reach = kReach * walk.besidePx;
  const glm::dvec2 across(-direction.y, direction.x);
  const glm::dvec2 to = at + walk.segmentPx * direction;
  const double left = colourDifference(ground.colourAt(to + reach * across), colour);
  const double right = colourDifference(ground.colourAt(to - reach * across), colour);
  const double most = kMost * walk.segmentPx;
  const double lean = std::clamp(kLean * reach * (right - left), -most, most);
  return glm::normalize(walk.segmentPx * direction + lean * across);
}

}  // namespace

glm::dvec2 strokeDirection(glm::dvec2 tensor) {
  const double theta = 0.5 * std::atan2(tensor.y, tensor.x) + std::numbers::pi / 2.0;
  return {std::cos(theta), std::sin(theta)};
}

double colourDifference(glm::dvec3 a, glm::dvec3 b) {
  const glm::dvec3 d = a - b;
  return std::sqrt(0.9 * d.r * d.r + 1.5 * d.g * d.g + 0.6 * d.b * d.b);
}

std::vector<glm::dvec2> thesisSkeleton(const StrokeGround& ground, const StrokeWalk& walk,
                                       glm::dvec2 anchor, glm::dvec2 heading) {
  std::vector<glm::dvec2> points{anchor};
  const glm::dvec3 start = ground.colourAt(anchor);
  for (int i = 0; i < walk.steps; ++i) {
    const glm::dvec2 direction = onward(strokeDirection(ground.tensorAt(points.back())), heading);
    if (i > 0 && angleOf(direction, heading) > walk.cutOffRad) break;
    const glm::dvec2 next = points.back() + walk.segmentPx * direction;
    if (colourDifference(ground.colourAt(next), start) > walk.colourThreshold) break;
    points.push_back(next);
    heading = direction;
  }
  return points;
}

StrokeArm strokeArm(const StrokeGround& ground, const StrokeWalk& walk, glm::dvec2 anchor,
                    glm::dvec2 heading) {
  StrokeArm arm;
  arm.length = walk.steps;
  const glm::dvec3 start = ground.colourAt(anchor);
  bool hasEnded = false;
  double before = 0.0;
  glm::dvec2 at = anchor;
  for (int i = 0; i < walk.steps; ++i) {
    const glm::dvec2 halfOn = at + 0.5 * walk.segmentPx * heading;
    glm::dvec2 direction = onward(strokeDirection(ground.tensorAt(halfOn)), heading);
    const double turn = angleOf(direction, heading);
    if (i > 0) arm.nearestToCutOff = std::min(arm.nearestToCutOff, std::abs(turn - walk.cutOffRad));
    if (!hasEnded && i > 0 && turn > walk.cutOffRad) {
      arm.length = i;
      hasEnded = true;
    }
    direction = leaned(ground, walk, at, direction, start);
    at += walk.segmentPx * direction;
    const double difference = colourDifference(ground.colourAt(at), start);
    if (!hasEnded && difference > walk.colourThreshold) {
      const double part = (walk.colourThreshold - before) / (difference - before);
      arm.length = std::max(i + std::clamp(part, 0.0, 1.0), walk.minSteps);
      hasEnded = true;
    }
    before = difference;
    arm.directions.push_back(direction);
    heading = direction;
  }
  return arm;
}

glm::dvec2 averagedDirection(glm::dvec2 now, glm::dvec2 past, double pastShare) {
  constexpr int kSteps = 20'000;
  const auto doubled = [](glm::dvec2 d) {
    return glm::dvec2(d.x * d.x - d.y * d.y, 2.0 * d.x * d.y);
  };
  const double stays = std::pow(pastShare, 1.0 / kSteps);
  glm::dvec2 mean = doubled(past);
  for (int i = 0; i < kSteps; ++i) {
    mean = glm::normalize((1.0 - stays) * doubled(now) + stays * mean);
  }
  const double angle = 0.5 * std::atan2(mean.y, mean.x);
  return {std::cos(angle), std::sin(angle)};
}

glm::dvec2 splinePlace(const std::vector<glm::dvec2>& points, double s) {
  std::vector<glm::dvec2> control(2, points.front());
  control.insert(control.end(), points.begin(), points.end());
  control.insert(control.end(), 2, points.back());
  const std::size_t segments = control.size() - 3;
  const auto segment = std::min(static_cast<std::size_t>(s), segments - 1);
  const double t = s - static_cast<double>(segment);
  const glm::dvec2* c = &control[segment];
  return (std::pow(1.0 - t, 3.0) * c[0] + (3.0 * t * t * t - 6.0 * t * t + 4.0) * c[1] +
          (-3.0 * t * t * t + 3.0 * t * t + 3.0 * t + 1.0) * c[2] + t * t * t * c[3]) /
         6.0;
}

std::vector<glm::dvec2> thesisSplineSamples(const std::vector<glm::dvec2>& points) {
  const int segments = static_cast<int>(points.size()) - 1 + 2;
  std::vector<glm::dvec2> samples;
  for (int i = 0; i <= 4 * segments; ++i) samples.push_back(splinePlace(points, i / 4.0));
  return samples;
}

glm::dvec3 bumpNormal(double left, double right, double bottom, double top) {
  return glm::normalize(glm::dvec3(left - right, bottom - top, 1.0));
}

glm::dvec3 litPaint(glm::dvec3 paint, glm::dvec3 normal, double gloss) {
  const glm::dvec3 light = glm::normalize(glm::dvec3(-3.0, -4.0, 3.0));
  const double lit = std::clamp(glm::dot(normal, light) / light.z, 0.3, 1.8);
  const glm::dvec3 halfway = glm::normalize(light + glm::dvec3(0.0, 0.0, 1.0));
  const double shine = std::pow(std::max(glm::dot(normal, halfway), 0.0), 40.0);
  const double flat = std::pow(halfway.z, 40.0);
  return glm::clamp(paint * (1.0 + 0.6 * (lit - 1.0)) + gloss * std::max(shine - flat, 0.0), 0.0,
                    1.0);
}

double paintableShare(const std::vector<bool>& its) {
  constexpr double kTent[3] = {0.25, 0.5, 0.25};
  double share = 0.0;
  for (std::size_t i = 0; i < 9; ++i) {
    if (its[i]) share += kTent[i / 3] * kTent[i % 3];
  }
  return share;
}

}  // namespace pleinair::oracles
