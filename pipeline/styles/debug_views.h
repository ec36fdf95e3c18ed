#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "pipeline/gpu/programs/shader_library.h"

namespace pleinair::styles {

/// One of a style's inner pictures, for people who want to see how it works.
struct DebugViewInfo {
  std::string_view name;  ///< "cells"
  std::string_view help;
};

/// The place of a view in its style's list, which is the number that its shader gets.
/// Precondition: it is one of them.
std::size_t viewIndex(std::span<const DebugViewInfo> views, std::string_view view);

/// `#define VIEW_CELLS 1` for each, so that the shader compares with the list's own numbers.
gpu::ShaderDefines viewDefines(std::span<const DebugViewInfo> views);

}  // namespace pleinair::styles
