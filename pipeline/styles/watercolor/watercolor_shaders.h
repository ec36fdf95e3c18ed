#pragma once

#include <span>

#include "pipeline/gpu/embedded_shader.h"

namespace pleinair::gpu {

/// The shaders of pipeline/styles/watercolor, made at build.
std::span<const EmbeddedShader> watercolorShaders();

}  // namespace pleinair::gpu
