#pragma once

#include <memory>

#include "firmware_app/configuration.h"
#include "hal/camera.h"
#include "hal/clock.h"

namespace pleinair::app {

/// A camera that delivers in real time: the synthetic one, or a recording, which is played over and
/// over at its own pace. Throws hal::StartupError (kNotFound) where there is neither. The clock
/// outlives the camera.
std::unique_ptr<hal::Camera> openCamera(const CameraSettings& settings, hal::Clock& clock);

}  // namespace pleinair::app
