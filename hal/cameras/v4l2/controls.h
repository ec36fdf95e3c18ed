#pragma once

#include "hal/camera.h"
#include "hal/cameras/v4l2/device.h"

namespace pleinair::hal::v4l2 {

/// Sets what is set in `controls`; leaves the rest as the device has it. Values are clamped to the
/// device's range and rounded to its steps. Errors: kUnsupported where the device lacks the control
/// (or its automatic), naming those that it has; kBusy, kIo.
Result<void> setControls(const Device& device, const CameraControls& controls);

}  // namespace pleinair::hal::v4l2
