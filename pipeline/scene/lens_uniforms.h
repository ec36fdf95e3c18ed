#pragma once

#include "pipeline/gpu/program.h"
#include "pipeline/tracking/camera_model.h"

namespace pleinair::scene {

/// Fills the uniforms of shaders/lens.glsl. Precondition: the program is in use.
void setLens(gpu::Program& program, const tracking::CameraModel& camera);

}  // namespace pleinair::scene
