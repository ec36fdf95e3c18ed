#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "pipeline/gpu/gl.h"

namespace pleinair::embedded_gpu {

/// A texture's format, by the name that records use.
struct FormatName {
  std::string_view name;
  GLenum internal;
  int bytesPerTexel;
};

/// Every format that the program makes textures of; "external" is of samplerExternalOES.
inline constexpr std::array kFormatNames{
    FormatName{"r8", GL_R8, 1},
    FormatName{"rg8", GL_RG8, 2},
    FormatName{"rgb8", GL_RGB8, 3},
    FormatName{"rgba8", GL_RGBA8, 4},
    FormatName{"srgb8_alpha8", GL_SRGB8_ALPHA8, 4},
    FormatName{"rgba16f", GL_RGBA16F, 8},
    FormatName{"rg16f", GL_RG16F, 4},
    FormatName{"r16f", GL_R16F, 2},
    FormatName{"r32f", GL_R32F, 4},
    FormatName{"rgba32f", GL_RGBA32F, 16},
    FormatName{"r32ui", GL_R32UI, 4},
    FormatName{"rg32ui", GL_RG32UI, 8},
    FormatName{"depth24", GL_DEPTH_COMPONENT24, 4},
    FormatName{"depth16", GL_DEPTH_COMPONENT16, 2},
    FormatName{"depth32f", GL_DEPTH_COMPONENT32F, 4},
    FormatName{"external", GL_NONE, 4},
};

/// The format of this name; null for one that is not in the list.
inline const FormatName* formatOf(std::string_view name) {
  const auto* found = std::ranges::find(kFormatNames, name, &FormatName::name);
  return found == kFormatNames.end() ? nullptr : found;
}

inline const FormatName* formatOf(GLenum internal) {
  const auto* found = std::ranges::find(kFormatNames, internal, &FormatName::internal);
  return found == kFormatNames.end() ? nullptr : found;
}

/// A kind of uniform that a texture or an image is bound to.
struct BindingKind {
  GLenum type;
  bool isImage;
  GLenum target;   ///< of samplers
  GLenum binding;  ///< what glGetIntegerv calls the texture that is bound to the target
};

inline constexpr std::array kBindingKinds{
    BindingKind{GL_SAMPLER_2D, false, GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D},
    BindingKind{GL_SAMPLER_2D_SHADOW, false, GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D},
    BindingKind{GL_INT_SAMPLER_2D, false, GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D},
    BindingKind{GL_UNSIGNED_INT_SAMPLER_2D, false, GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D},
    BindingKind{GL_SAMPLER_EXTERNAL_OES, false, GL_TEXTURE_EXTERNAL_OES,
                GL_TEXTURE_BINDING_EXTERNAL_OES},
    BindingKind{GL_IMAGE_2D, true, GL_NONE, GL_NONE},
    BindingKind{GL_INT_IMAGE_2D, true, GL_NONE, GL_NONE},
    BindingKind{GL_UNSIGNED_INT_IMAGE_2D, true, GL_NONE, GL_NONE},
};

/// Null for uniforms of other types.
inline const BindingKind* bindingKindOf(GLenum uniformType) {
  const auto* found = std::ranges::find(kBindingKinds, uniformType, &BindingKind::type);
  return found == kBindingKinds.end() ? nullptr : found;
}

}  // namespace pleinair::embedded_gpu
