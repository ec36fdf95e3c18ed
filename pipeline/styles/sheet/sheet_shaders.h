#pragma once

#include <span>

#include "pipeline/gpu/embedded_shader.h"

namespace pleinair::gpu {

/// The shaders of pipeline/styles/sheet, made at build.
std::span<const EmbeddedShader> sheetShaders();

}  // namespace pleinair::gpu
