#pragma once

#include <array>
#include <cstdint>

#include <glm/mat4x4.hpp>

#include "hal/cameras/synthetic/world/bodies.h"
#include "hal/cameras/synthetic/world/builder.h"

namespace pleinair::hal::synthetic {

/// The rigid parts of a figure, a simplified person.
enum class FigurePart : std::uint8_t {
  kTrunk,  ///< with the neck
  kHead,
  kLeftUpperArm,
  kLeftForearm,  ///< with the hand
  kLeftThigh,
  kLeftShin,
  kLeftFoot,
  kRightUpperArm,
  kRightForearm,
  kRightThigh,
  kRightShin,
  kRightFoot,
};

inline Body bodyOf(std::size_t figure, FigurePart part) {
  return static_cast<Body>(kFirstOfFigures + figure * kPartsPerFigure +
                           static_cast<std::size_t>(part));
}

/// A figure's joints, in radians; all zero: it stands upright and its arms hang.
struct FigureJoints {
  double lean = 0;      ///< of the trunk, forwards
  double twist = 0;     ///< of the trunk, to the left
  double headTurn = 0;  ///< to the left, from the trunk
  double headNod = 0;   ///< downwards
  struct Limbs {
    double shoulder = 0;  ///< the upper arm forwards
    double elbow = 0;     ///< bent
    double hip = 0;       ///< the thigh forwards
    double knee = 0;      ///< bent
    double ankle = 0;     ///< the toes up
  };
  Limbs left, right;
};

using FigurePoses = std::array<glm::dmat4, kPartsPerFigure>;

/// The poses of a figure's parts in the figure's frame: its origin on the floor below the hips, x
/// forwards, y to the figure's left, z up, metres. The lower foot touches the floor.
FigurePoses figureFromParts(std::size_t figure, const FigureJoints& joints);

/// How far a figure gets with two steps, if its thighs swing by `hipRadians` to either side.
double strideMetres(std::size_t figure, double hipRadians);

/// Adds the figures' parts, each in its body's coordinates: its joint at the origin, its axes those
/// of the standing figure. They are lit as they stand at `worldFromFigures`.
void buildFigures(Builder& builder, const std::array<glm::dmat4, kFigures>& worldFromFigures);

}  // namespace pleinair::hal::synthetic
