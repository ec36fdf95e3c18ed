#pragma once

#include <optional>
#include <variant>

#include "hal/clock.h"

namespace pleinair::hal {

/// The device's own control loop decides.
struct Automatic {
  friend bool operator==(const Automatic&, const Automatic&) = default;
};
template <class T>
using AutomaticOr = std::variant<Automatic, T>;

/// What can be set of a camera, by neutral names; unset: left as the device has it. A back end
/// converts to the device's units and clamps to its range; what the device does not have is an
/// error of start() (kUnsupported) that names the control.
struct CameraControls {
  std::optional<AutomaticOr<Duration>> exposure;
  std::optional<AutomaticOr<double>> gain;   ///< share of the device's range, 0 … 1
  std::optional<AutomaticOr<double>> focus;  ///< likewise, 0 … 1, in the device's direction
  std::optional<AutomaticOr<double>> whiteBalance;  ///< colour temperature, K
  friend bool operator==(const CameraControls&, const CameraControls&) = default;
};

}  // namespace pleinair::hal
