#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "config/parameter_values.h"
#include "hal/error.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/styles/style.h"

namespace pleinair::styles {

/// A style that can be made, and all that is known of it without a GPU.
struct StyleInfo {
  std::string_view name;
  std::string_view help;
  std::span<const DebugViewInfo> views;
  std::span<const Look> looks;  ///< the first is what the defaults are; may be empty
  config::ParameterValues defaults;
  /// Whether what parameters name outside the program is there and sound; null: they name nothing.
  hal::Result<void> (*check)(const config::ParameterValues& values) = nullptr;

  /// The defaults under the look's values, whose origin names the look. Throws config::ConfigError
  /// for an unknown name, with all names.
  config::ParameterValues parametersOf(std::string_view look) const;
};

/// All styles, in the order in which they are listed. Any thread.
std::span<const StyleInfo> styleInfos();

/// One of them. Throws hal::Failure (kInvalidArgument) for an unknown name, with all names.
const StyleInfo& styleInfo(std::string_view name);

/// Adds the shaders of all styles, which makeStyle() needs.
void addStyleShaders(gpu::ShaderLibrary& library);

/// Makes a style, on the thread of the current GL context, with its programs warmed up. Throws as
/// styleInfo() does.
std::unique_ptr<Style> makeStyle(std::string_view name, const gpu::ShaderLibrary& library);

}  // namespace pleinair::styles
