#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/gpu/texture.h"

namespace pleinair::gpu {

struct ContextInfo;

/// How a full-screen pass runs: as a fragment shader over one triangle, or as the same text in a
/// compute shader that writes to images, one invocation a pixel. Values are the same but for the
/// driver's rounding.
enum class PassForm { kFragment, kCompute };

/// The faster form on a context's GPU. kCompute on NVIDIA's own driver, measured on an H200, which
/// has few units that draw (docs/decisions/0115-passes-as-compute.md). Tile-based GPUs keep what is
/// drawn compressed; other drivers were not measured.
PassForm fasterPassForm(const ContextInfo& context);

/// Whether the current context can write to images of all formats that a target can have
/// (GL_NV_image_formats), as kCompute takes.
bool hasComputeForm();

/// The formats of a pass's outputs, by their locations.
using PassTargets = std::vector<TextureFormat>;

/// Lines that computeFormOf() puts behind the first one.
inline constexpr int kComputeFormLines = 2;

/// A fragment shader's expanded text as a compute shader's. The shader may read gl_FragCoord.xy; it
/// has no other inputs, neither derivatives nor `discard`, and samples no smaller levels of
/// textures by itself. Throws hal::Failure (kInternal) where its outputs are not `targets`, where
/// "void main()" is missing, and where it uses inputs, functions or variables that only fragment
/// shaders have.
std::string computeFormOf(std::string_view fragment, std::span<const TextureFormat> targets);

}  // namespace pleinair::gpu
