#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>

namespace pleinair::scene {

/// The numbers that define a spur gear's teeth (ISO 53 basic rack: addendum one module, dedendum
/// 1.25).
struct ToothForm {
  int teeth = 18;
  double moduleMetres = 0.005;  ///< pitch diameter = teeth · module
  double pressureAngleRad = 0.3490658503988659;
  friend bool operator==(const ToothForm&, const ToothForm&) = default;
};

struct GearRadii {
  double rootMetres = 0.0;
  double baseMetres = 0.0;   ///< base circle of the involutes
  double pitchMetres = 0.0;  ///< radius at which a tooth is as wide as a gap
  double tipMetres = 0.0;    ///< lowered where the tooth would become too thin
};

GearRadii gearRadii(const ToothForm& form);

/// Half of a tooth's thickness at a radius, as an angle about the gear's axis: π / (2 z) on the
/// pitch circle, involute from the base circle up, radial below. A gear cut by a rack would be
/// thinner there (undercut, under 17 teeth at 20°). Without undercut, all gears mesh and no tooth
/// is weak.
double halfToothAngleRad(const ToothForm& form, double radiusMetres);

/// One turn of the outline, counter-clockwise, and the period of its points.
struct GearProfile {
  std::vector<glm::dvec2> points;  ///< metres; tooth 0 points along x
  std::size_t pointsPerTooth = 0;  ///< of a tooth and the root after it
  /// The first points of each period that belong to the tooth itself; an even number, symmetric
  /// about its centre.
  std::size_t toothPoints = 0;
};

GearProfile gearProfile(const ToothForm& form);

}  // namespace pleinair::scene
