#pragma once

#include <nlohmann/json.hpp>

#include "pipeline/gpu/gl.h"

namespace pleinair::embedded_gpu {

/// What the current program finds bound, as drivers need it to choose a variant: formats of
/// textures and images by the names of their uniforms and, for a draw, formats of targets, vertex
/// attributes, blending, depth and culling. README.md describes the object. Asks GL only.
nlohmann::json stateOfDispatch(GLuint program);
nlohmann::json stateOfDraw(GLuint program, GLenum mode, bool isIndexed);

/// How large the bound textures, images and targets are: bytes of a texel and texels, by name.
nlohmann::json sizesOfDispatch(GLuint program);
nlohmann::json sizesOfDraw(GLuint program);

}  // namespace pleinair::embedded_gpu
