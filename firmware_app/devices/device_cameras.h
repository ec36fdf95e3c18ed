#pragma once

#include <span>
#include <vector>

#include "hal/camera_backend.h"
#include "hal/error.h"
#include "hal/supervisor/camera_selector.h"

namespace pleinair::app {

/// The cameras that are devices, of all back ends.
struct DeviceCameras {
  std::vector<hal::CameraDescription> cameras;
  std::vector<hal::Error> problems;  ///< of back ends that could not list theirs
};

DeviceCameras listDeviceCameras(std::span<const hal::SelectableBackend> backends);

}  // namespace pleinair::app
