#pragma once

#include <span>
#include <string_view>

#include "hal/camera_kind.h"

namespace pleinair::hal {

/// Every kind of cameras that this build has, in the order in which "auto" tries them. Made by
/// CMake from the list in hal/cameras/CMakeLists.txt.
std::span<const CameraKind* const> cameraKinds();

}  // namespace pleinair::hal
