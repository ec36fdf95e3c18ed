#pragma once

#include <span>

#include "pipeline/gpu/embedded_shader.h"

namespace pleinair::gpu {

/// The shaders of pipeline/present.
std::span<const EmbeddedShader> presentShaders();

}  // namespace pleinair::gpu
