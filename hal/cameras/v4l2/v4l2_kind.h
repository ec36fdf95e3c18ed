#pragma once

#include "hal/camera_kind.h"

namespace pleinair::hal::v4l2 {

/// V4L2 devices. No keys of their own: size, rate and controls are those of all cameras.
const CameraKind& cameraKind();

}  // namespace pleinair::hal::v4l2
