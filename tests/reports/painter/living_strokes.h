#pragma once

#include <filesystem>

#include "hal/image.h"
#include "pipeline/gpu/shader_library.h"

namespace pleinair {

/// The thesis's figure 26 with ours: a photograph under a pan, painted, and below it the same
/// without coherence; three frames of each, ten apart. Strokes of the first that live are circled
/// in all of them; one that is gone is crossed out where it would be. The motion is told. `library`
/// has the shaders of all styles; a GL context is current. Throws hal::Failure: of the
/// photograph.
hal::Image livingStrokes(const gpu::ShaderLibrary& library,
                         const std::filesystem::path& photograph);

}  // namespace pleinair
