#pragma once

#include "hal/camera_kind.h"
#include "hal/cameras/synthetic/synthetic_camera.h"

namespace pleinair::hal::synthetic {

/// The simulated camera, by its shots. [camera.synthetic] has its keys (docs/workbench.md).
const CameraKind& cameraKind();

/// Options from [camera.synthetic] and the settings of all cameras.
SyntheticOptions optionsOf(const config::ParameterValues& own, const CameraBackendOptions& options);

}  // namespace pleinair::hal::synthetic
