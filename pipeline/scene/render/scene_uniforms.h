#pragma once

#include "pipeline/gpu/programs/program.h"
#include "pipeline/scene/light/lighting.h"
#include "pipeline/scene/render/ar_frame.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::scene {

/// Fills the uniforms of shaders/lens.glsl. Precondition: the program is in use.
void setLens(gpu::Program& program, const tracking::CameraModel& camera);

/// Fills the uniforms of shaders/shading_toon.glsl or shading_smooth.glsl with light in the
/// camera's frame. Precondition: the program is in use.
void setLighting(gpu::Program& program, const Lighting& cameraLight, Shading shading);

/// The factor on sRGB-coded colours where the key light does not reach: the hue of ambient light
/// relative to all light, at equal brightness.
glm::vec3 shadeTint(const Lighting& light);

/// The factor of toon's darkest band: the thesis's 0.1 or, if ambient light is known, a little less
/// than the brightness of real shade, so that models do not look burnt beside real objects.
float deepestShade(const Lighting& light);

}  // namespace pleinair::scene
