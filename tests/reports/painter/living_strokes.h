#pragma once

#include <filesystem>

#include "hal/image.h"
#include "pipeline/gpu/shader_library.h"

namespace pleinair {

/// The counterpart of the thesis's figure 26: a photograph under a pan, painted, and below it the
/// same without coherence; three frames each, ten apart. Living strokes of the first frame are
/// circled in all of them; a stroke that is gone is crossed out at its expected place. The motion
/// is given. `library` has the shaders of all styles; a GL context is current. Throws hal::Failure
/// for the photograph.
hal::Image livingStrokes(const gpu::ShaderLibrary& library,
                         const std::filesystem::path& photograph);

}  // namespace pleinair
