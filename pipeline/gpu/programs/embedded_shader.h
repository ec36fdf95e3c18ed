#pragma once

#include <string_view>

namespace pleinair::gpu {

/// A shader file embedded at build (cmake/PleinairShaders.cmake).
struct EmbeddedShader {
  std::string_view name;  ///< its path from the top of the tree
  std::string_view text;
};

}  // namespace pleinair::gpu
