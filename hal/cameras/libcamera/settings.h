#pragma once

#include "hal/camera.h"
#include "hal/cameras/libcamera/library.h"

namespace pleinair::hal::libcamera {

/// The camera's units for a request's controls and rate, clamped to its ranges. Exposure is a time;
/// gain and focus are shares of the range, focus from far to near; white balance is a colour
/// temperature. Errors: kUnsupported if the camera lacks a control, with those that it has.
/// Precondition: configured.
Result<StartSettings> settingsFor(Device& device, const StreamRequest& request);

}  // namespace pleinair::hal::libcamera
