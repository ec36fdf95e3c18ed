#pragma once

#include <optional>
#include <string>

#include "hal/camera.h"
#include "hal/cameras/v4l2/device.h"

namespace pleinair::hal::v4l2 {

/// The frequency of lamps' flicker, which the device's own exposure avoids: that of the mains, or
/// found out by the device.
enum class PowerLine { kOff, k50Hz, k60Hz, kAuto };

/// Sets the given controls and reads them back; unset ones keep the device's values. Values are
/// clamped to the device's range and rounded to its steps. Gives a line where the device has kept
/// another value; empty: all are as set. Errors: kUnsupported if the device lacks a control (or its
/// automatic mode), with the available ones; kBusy, kIo.
Result<std::string> setControls(const Device& device, const CameraControls& controls,
                                std::optional<PowerLine> powerLine = {});

}  // namespace pleinair::hal::v4l2
