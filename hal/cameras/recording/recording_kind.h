#pragma once

#include "hal/camera_kind.h"

namespace pleinair::hal::recording {

/// Recordings, by their paths (recording.h). [camera.recording]: whether one that is played live
/// starts over at its end, and how fast pictures without times of their own follow each other.
const CameraKind& cameraKind();

}  // namespace pleinair::hal::recording
