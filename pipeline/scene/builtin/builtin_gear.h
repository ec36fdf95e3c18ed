#pragma once

#include <optional>
#include <string>

#include "pipeline/scene/builtin/gear_profile.h"
#include "pipeline/scene/models/mesh.h"

namespace pleinair::scene {

/// A spur gear with a bore, a hub, and a web that is recessed and pierced where there is room. It
/// lies on z = 0; its axis is along z.
struct GearParameters {
  ToothForm form;
  double thicknessMetres = 0.015;
  std::optional<double> boreDiameterMetres;  ///< default: 0.18 of the pitch diameter
  std::optional<double> hubDiameterMetres;   ///< default: 0.36 of the pitch diameter
  std::optional<int> holes;                  ///< in the web; default: 5 if they fit, else none
  friend bool operator==(const GearParameters&, const GearParameters&) = default;
};

/// The reason why a gear cannot be made.
struct GearFault {
  std::string key;      ///< the key in a scene file: "bore_diameter_m"
  std::string problem;  ///< "too wide for the teeth"
  std::string allowed;  ///< "at most 0.0675"
};

/// Checks a gear whose basic values are in range: at least 6 teeth, all lengths > 0. Returns
/// nothing if it can be made.
std::optional<GearFault> faultOf(const GearParameters& gear);

/// Precondition: faultOf(gear) is nothing.
Mesh gearMesh(const GearParameters& gear);

}  // namespace pleinair::scene
