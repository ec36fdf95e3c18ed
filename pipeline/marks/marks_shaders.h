#pragma once

#include <span>

#include "pipeline/gpu/embedded_shader.h"

namespace pleinair::gpu {

/// The shaders of pipeline/marks, made at build.
std::span<const EmbeddedShader> marksShaders();

}  // namespace pleinair::gpu
