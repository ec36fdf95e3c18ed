#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "pipeline/gpu/shader_library.h"
#include "pipeline/styles/style.h"

namespace pleinair::styles {

/// A style that can be made.
struct StyleInfo {
  std::string_view name;
  std::string_view help;
};

/// All styles, in the order in which they are listed.
std::span<const StyleInfo> styleInfos();

/// Adds the shaders of all styles, which makeStyle() needs.
void addStyleShaders(gpu::ShaderLibrary& library);

/// Makes a style, on the thread of the current GL context, with its programs warmed up. Throws
/// hal::StartupError (kInvalidArgument) for an unknown name, with all names.
std::unique_ptr<Style> makeStyle(std::string_view name, const gpu::ShaderLibrary& library);

}  // namespace pleinair::styles
