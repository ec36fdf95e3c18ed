#include "hal/cameras/synthetic/render/visitors.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include "hal/cameras/synthetic/world/figure.h"
#include "hal/cameras/synthetic/world/workbench.h"

namespace pleinair::hal::synthetic {
namespace {

constexpr double kHipSwing = 0.42;  // radians to either side

/// A walk along x. A stop takes `stopSeconds` at rest, and kRampSeconds before and after it.
struct Walk {
  double startSeconds;
  double from, to;  ///< metres; the figure looks from `from` to `to`
  double speed;     ///< metres per second
  double stopAt;    ///< metres walked before it stands; beyond the walk's end: it does not stop
  double stopSeconds;
};
constexpr double kRampSeconds = 0.7;
constexpr double kNever = 1e9;
using Walks = std::array<Walk, kFigures>;
constexpr Walks kOneByOne{{{1.0, -2.1, 3.05, 1.15, kNever, 0}, {7.4, 3.05, -2.1, 1.10, 2.65, 2.0}}};
constexpr Walks kBothAtOnce{
    {{1.0, -2.1, 3.05, 1.15, kNever, 0}, {0.9, 3.05, -2.1, 1.10, kNever, 0}}};
constexpr double kAside = 0.55;  ///< metres that the second figure passes nearer by, beside what
                                 ///< its lane is nearer already

/// How far along its way a figure is.
struct Progress {
  double metres = 0;
  double pace = 1;     ///< its speed, as a share of the walk's
  double stopped = 0;  ///< 0 … 1 … 0 from the beginning of the stop to its end
};

/// The integral of smoothstep from 0 to t, t within 0 … 1.
double smoothstepArea(double t) {
  return t * t * t - t * t * t * t / 2;
}

Progress progressOf(const Walk& walk, double seconds) {
  const double length = std::abs(walk.to - walk.from);
  const double t = std::fmax(seconds - walk.startSeconds, 0);
  const double brake = walk.stopAt / walk.speed - kRampSeconds / 2;
  const double leave = brake + kRampSeconds + walk.stopSeconds;
  Progress progress;
  if (t <= brake) {
    progress.metres = walk.speed * t;
  } else {
    const double braked = glm::clamp((t - brake) / kRampSeconds, 0.0, 1.0);
    const double left = glm::clamp((t - leave) / kRampSeconds, 0.0, 1.0);
    const double after = std::fmax(t - leave - kRampSeconds, 0);
    progress.pace = 1 - glm::smoothstep(0.0, 1.0, braked) + glm::smoothstep(0.0, 1.0, left);
    progress.metres = walk.speed * (brake + kRampSeconds * (braked - smoothstepArea(braked)) +
                                    kRampSeconds * smoothstepArea(left) + after);
    progress.stopped =
        glm::smoothstep(brake + 0.4, brake + 1.1, t) - glm::smoothstep(leave - 0.4, leave + 0.4, t);
  }
  progress.metres = std::fmin(progress.metres, length);
  return progress;
}

/// −1 … 1, with nearly constant speed between its turning points: a foot on the floor stays there.
double swingOf(double phase) {
  constexpr double kSharpness = 0.92;
  return std::asin(kSharpness * std::sin(phase)) / std::asin(kSharpness);
}

FigureJoints::Limbs walkingLeg(double phase, double pace) {
  FigureJoints::Limbs limbs;
  limbs.hip = pace * kHipSwing * swingOf(phase);
  const double lifted = (1 + std::cos(phase + 0.2)) / 2;
  limbs.knee = pace * (0.08 + 0.95 * lifted * lifted * lifted);
  limbs.ankle = 0.45 * (limbs.knee - limbs.hip);
  return limbs;
}

void swingArm(double phase, double pace, FigureJoints::Limbs& limbs) {
  limbs.shoulder = pace * 0.42 * std::sin(phase);
  limbs.elbow = 0.16 + pace * (0.28 + 0.22 * std::sin(phase));
}

FigureJoints jointsOf(const Progress& progress, double stride) {
  const double phase = 2 * std::numbers::pi * progress.metres / stride;
  const double pace = progress.pace;
  FigureJoints joints;
  joints.lean = 0.06 * pace;
  joints.twist = 0.10 * pace * std::sin(phase);
  joints.left = walkingLeg(phase, pace);
  joints.right = walkingLeg(phase + std::numbers::pi, pace);
  swingArm(phase + std::numbers::pi, pace, joints.left);
  swingArm(phase, pace, joints.right);
  // Stopped, it turns its head to the camera and raises a hand.
  joints.headTurn = 1.15 * progress.stopped;
  joints.headNod = 0.04;
  joints.left.shoulder += 0.55 * progress.stopped;
  joints.left.elbow += 1.55 * progress.stopped;
  return joints;
}

/// Places the figures at `seconds` of walks that start over after `period`; the second figure is
/// nearer to the camera by `aside` metres.
void placeWalks(const Walks& walks, double period, double aside, double seconds,
                BodyPoses& bodies) {
  const double t = seconds - period * std::floor(seconds / period);
  for (std::size_t figure = 0; figure < kFigures; ++figure) {
    const Walk& walk = walks[figure];
    const Progress progress = progressOf(walk, t);
    const double direction = walk.to > walk.from ? 1 : -1;
    const glm::dvec3 nearer(0, figure == 0 ? 0 : -aside, 0);
    const glm::dmat4 worldFromFigure = glm::translate(glm::dmat4(1), nearer) *
                                       visitorPose(figure, walk.from + direction * progress.metres);
    const FigurePoses parts =
        figureFromParts(figure, jointsOf(progress, strideMetres(figure, kHipSwing)));
    for (std::size_t part = 0; part < parts.size(); ++part) {
      bodies.place(bodyOf(figure, static_cast<FigurePart>(part)), worldFromFigure * parts[part]);
    }
  }
}

}  // namespace

void placeVisitors(double seconds, BodyPoses& bodies) {
  placeWalks(kOneByOne, kVisitorsSeconds, 0, seconds, bodies);
}

void placeCrossing(double seconds, BodyPoses& bodies) {
  placeWalks(kBothAtOnce, kCrossingSeconds, kAside, seconds, bodies);
}

}  // namespace pleinair::hal::synthetic
