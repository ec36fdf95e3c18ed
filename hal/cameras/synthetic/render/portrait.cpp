#include "hal/cameras/synthetic/render/portrait.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>

#include "hal/cameras/synthetic/world/figure.h"
#include "hal/cameras/synthetic/world/workbench.h"

namespace pleinair::hal::synthetic {
namespace {

constexpr glm::dvec3 kPlace{1.95, -2.20, kFloorZ};

/// Goes to and fro `times` in the shot.
double swaying(double seconds, int times, double phase = 0) {
  return std::sin(2 * std::numbers::pi * (times * seconds / kPortraitSeconds + phase));
}

}  // namespace

void placePortrait(double seconds, BodyPoses& bodies) {
  constexpr std::size_t kFigure = 0;
  const double t = seconds - kPortraitSeconds * std::floor(seconds / kPortraitSeconds);
  FigureJoints joints;
  joints.lean = 0.05 + 0.05 * swaying(t, 3);
  joints.twist = 0.16 * swaying(t, 4, 0.1);
  joints.headTurn = 0.45 * swaying(t, 5, 0.3) + 0.15 * swaying(t, 11);
  joints.headNod = 0.04 + 0.10 * swaying(t, 7, 0.2);
  const double raised = glm::smoothstep(0.2, 0.9, swaying(t, 2, 0.4));
  joints.right.shoulder = 1.05 * raised;
  joints.right.elbow = 0.16 + 1.35 * raised + 0.15 * raised * swaying(t, 17);
  joints.left.elbow = 0.16;
  constexpr double kAway = 1.15;  // metres to the side: beyond the image
  const double there = glm::smoothstep(0.5, 2.2, t) - glm::smoothstep(9.3, 11.0, t);
  const double aside = kAway * (1 - there) + 0.05 * swaying(t, 4) + 0.02 * swaying(t, 9, 0.6);
  const glm::dvec3 place = kPlace + glm::dvec3(0.03 * swaying(t, 3, 0.5), aside, 0);
  const glm::dmat4 worldFromFigure =
      glm::rotate(glm::translate(glm::dmat4(1), place), std::numbers::pi, glm::dvec3(0, 0, 1));
  const FigurePoses parts = figureFromParts(kFigure, joints);
  for (std::size_t part = 0; part < parts.size(); ++part) {
    bodies.place(bodyOf(kFigure, static_cast<FigurePart>(part)), worldFromFigure * parts[part]);
  }
}

}  // namespace pleinair::hal::synthetic
