#pragma once

#include <memory>

#include "hal/cameras/aravis/arv_handles.h"
#include "hal/cameras/aravis/library.h"

namespace pleinair::hal::aravis {

/// The settings of an open camera, by Aravis' calls.
std::unique_ptr<Device> arvDevice(Object<ArvCamera> camera);

}  // namespace pleinair::hal::aravis
