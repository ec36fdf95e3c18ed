#pragma once

#include <array>
#include <optional>

#include "pipeline/scene/builtin/builtin_gear.h"
#include "pipeline/scene/builtin/gear_profile.h"
#include "pipeline/scene/models/model.h"

namespace pleinair::scene {

/// A two-stage gearbox without its cover: three parallel shafts in a cast housing, the input
/// towards the reader of the tag, the output away. It stands on its feet on z = 0, centred over the
/// origin, x along its length.
struct GearboxParameters {
  double lengthMetres = 0.25;         ///< over its feet, along x; all other lengths follow
  double inputRevolutions = 12.0;     ///< per minute, counter-clockwise as the reader sees it
  std::array<int, 2> stage1{19, 43};  ///< teeth of the pinion and of the wheel
  std::array<int, 2> stage2{18, 40};
  bool isClosed = false;  ///< with its cover on
  friend bool operator==(const GearboxParameters&, const GearboxParameters&) = default;
};

inline constexpr int kMinPinionTeeth = 16;
inline constexpr int kMaxPinionTeeth = 30;
inline constexpr int kMinWheelTeeth = 36;
inline constexpr int kMaxWheelTeeth = 60;

/// A gear of the gearbox in the plane across the shafts: x along the gearbox, y up.
struct GearboxGear {
  ToothForm form;
  glm::dvec2 centre{0.0};  ///< metres
  double phaseRad = 0.0;   ///< of tooth 0 at rest, counter-clockwise from x
  double radiansPerSecond = 0.0;
};

/// Returns gear_1 to gear_4: pinion and wheel of the first stage, then of the second. Numbers of
/// teeth must be in the ranges above.
std::array<GearboxGear, 4> gearboxGears(const GearboxParameters& parameters);

/// Parts: housing, sight_glass, oil_plug, name_plate; input_shaft, intermediate_shaft,
/// output_shaft; gear_1 … gear_4; input_coupling, output_key; bearing_1 … bearing_6 (front and back
/// of each shaft: NAME_outer_race, NAME_inner_race, NAME_balls); end_cover_1 … end_cover_3; bolt_1
/// …; stud_1 … or, closed, cover and its bolts.
Model gearboxModel(const GearboxParameters& parameters);

}  // namespace pleinair::scene
