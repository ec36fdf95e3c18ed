#pragma once

#include <span>
#include <string>
#include <string_view>

#include "hal/error.h"

namespace pleinair::hal {

/// A control of a device, by the name of its key in [camera].
struct OfferedControl {
  std::string_view name;
  bool hasValue = false, hasAutomatic = false;
};

/// kUnsupported, without a subject: the device lacks the control that a setting asks for. The
/// remedy lists those that it has: "the device has exposure, gain (no auto)".
inline Error missingControl(std::string_view what, std::span<const OfferedControl> offered) {
  std::string has;
  for (const OfferedControl& each : offered) {
    if (!each.hasValue && !each.hasAutomatic) continue;
    if (!has.empty()) has += ", ";
    has += each.name;
    if (!each.hasValue) has += " (auto only)";
    if (!each.hasAutomatic) has += " (no auto)";
  }
  return {.kind = ErrorKind::kUnsupported,
          .problem = "has no control of " + std::string(what),
          .remedy = has.empty() ? "remove the setting; the device has no such controls"
                                : "remove the setting; the device has " + has};
}

}  // namespace pleinair::hal
