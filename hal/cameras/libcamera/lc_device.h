#pragma once

#include <memory>

#include "hal/cameras/libcamera/lc_manager.h"
#include "hal/cameras/libcamera/lc_version.h"
#include "hal/cameras/libcamera/library.h"

namespace pleinair::hal::libcamera {

/// The settings of a camera that was acquired, by libcamera's calls.
std::unique_ptr<Device> lcDevice(std::shared_ptr<Manager> manager,
                                 std::shared_ptr<lc::Camera> camera);

}  // namespace pleinair::hal::libcamera
