#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>

namespace pleinair::scene {

/// What makes a spur gear's teeth (ISO 53 basic rack: addendum one module, dedendum 1.25).
struct ToothForm {
  int teeth = 18;
  double moduleMetres = 0.005;  ///< pitch diameter = teeth · module
  double pressureAngleRad = 0.3490658503988659;
  friend bool operator==(const ToothForm&, const ToothForm&) = default;
};

struct GearRadii {
  double rootMetres = 0.0;
  double baseMetres = 0.0;   ///< of the involutes
  double pitchMetres = 0.0;  ///< where a tooth is as wide as a gap
  double tipMetres = 0.0;    ///< lowered where the tooth would end in a knife's edge
};

GearRadii gearRadii(const ToothForm& form);

/// Half of a tooth's thickness at a radius, as an angle about the gear's axis: π / (2 z) on the
/// pitch circle, involute from the base circle up, radial below. There a gear cut by a rack would
/// be thinner (undercut, under 17 teeth at 20°); leaving it out keeps teeth that mesh and stand.
double halfToothAngleRad(const ToothForm& form, double radiusMetres);

/// One turn of the outline, against the clock, and how its points repeat.
struct GearProfile {
  std::vector<glm::dvec2> points;  ///< metres; tooth 0 points along x
  std::size_t pointsPerTooth = 0;  ///< a tooth and the root after it
  /// The first so many of them are the tooth itself, even, symmetric about its middle.
  std::size_t toothPoints = 0;
};

GearProfile gearProfile(const ToothForm& form);

}  // namespace pleinair::scene
