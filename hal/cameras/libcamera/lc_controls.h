#pragma once

#include <array>
#include <optional>

#include "hal/cameras/libcamera/lc_version.h"
#include "hal/cameras/libcamera/library.h"
#include "hal/clock.h"

namespace pleinair::hal::libcamera {

/// What a value of the control may be; nothing if the camera lacks it.
std::optional<ControlRange> rangeOf(const lc::Camera& camera, Control control);
/// Whether the camera can set it by itself. Exposure and gain have modes of their own from 0.5 on,
/// and share one switch before.
bool hasAutomatic(const lc::Camera& camera, Control control);
/// The frame periods that the configured camera can have.
std::optional<std::array<Duration, 2>> periodsOf(const lc::Camera& camera);
/// What a stream is started with. Precondition: the camera has each control that is set.
lc::ControlList controlsOf(const lc::Camera& camera, const StartSettings& settings);

}  // namespace pleinair::hal::libcamera
