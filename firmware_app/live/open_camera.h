#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/pixel_format.h"

namespace pleinair::app {

/// A camera that delivers in real time: "synthetic", or the path of a recording, which is played
/// over and over at its own pace. `size` is what a camera that has the choice delivers. Throws
/// hal::StartupError (kInvalidArgument) for another name. The clock outlives the camera.
std::unique_ptr<hal::Camera> openCamera(const std::string& name,
                                        const std::optional<hal::FrameSize>& size,
                                        hal::Clock& clock);

}  // namespace pleinair::app
