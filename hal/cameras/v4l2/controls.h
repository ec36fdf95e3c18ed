#pragma once

#include "hal/camera.h"
#include "hal/cameras/v4l2/device.h"

namespace pleinair::hal::v4l2 {

/// Sets the given controls; unset ones keep the device's values. Values are clamped to the device's
/// range and rounded to its steps. Errors: kUnsupported if the device lacks a control (or its
/// automatic mode), with the available ones; kBusy, kIo.
Result<void> setControls(const Device& device, const CameraControls& controls);

}  // namespace pleinair::hal::v4l2
