#pragma once

#include <span>

#include "pipeline/gpu/embedded_shader.h"

namespace pleinair::gpu {

/// The shaders of pipeline/styles/painterly, made at build.
std::span<const EmbeddedShader> painterlyShaders();

}  // namespace pleinair::gpu
