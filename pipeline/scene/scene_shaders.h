#pragma once

#include <span>

#include "pipeline/gpu/embedded_shader.h"

namespace pleinair::gpu {

/// The shaders of pipeline/scene.
std::span<const EmbeddedShader> sceneShaders();

}  // namespace pleinair::gpu
