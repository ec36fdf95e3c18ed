#pragma once

#include <memory>
#include <vector>

#include "hal/camera_backend.h"
#include "hal/error.h"

namespace pleinair::app {

/// The cameras that are devices, of all back ends.
struct DeviceCameras {
  std::vector<hal::CameraDescription> cameras;
  std::vector<hal::Error> problems;  ///< of back ends that could not list theirs
};

DeviceCameras listDeviceCameras();

}  // namespace pleinair::app
