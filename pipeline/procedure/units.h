#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "pipeline/procedure/procedure.h"

namespace pleinair::procedure {

/// Units that torques may have.
std::span<const std::string> torqueUnits();
/// Units that checked values may have.
std::span<const std::string> valueUnits();

/// A torque as an author writes it, "25 Nm" or "25 ± 2 Nm" (also "+-"), or why it is none.
struct TorqueReading {
  std::optional<Torque> torque;
  std::string problem;  ///< "has no unit", `unknown unit "NM" (did you mean "Nm"?)`
};
TorqueReading readTorque(std::string_view text);

}  // namespace pleinair::procedure
