#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/styles/style.h"

namespace pleinair::styles {

/// All styles, in the order in which they are listed. Any thread.
std::span<const StyleKind* const> styleKinds();

/// One of them. Throws hal::Failure (kInvalidArgument) for an unknown name, with all names.
const StyleKind& styleKind(std::string_view name);

/// Adds the shaders of all styles, which makeStyle() needs, each once.
void addStyleShaders(gpu::ShaderLibrary& library);

/// Makes a style as StyleKind::make does. Throws as styleKind() does.
std::unique_ptr<Style> makeStyle(std::string_view name, const gpu::ShaderLibrary& library,
                                 SceneContents contents = SceneContents::kModels);

}  // namespace pleinair::styles
