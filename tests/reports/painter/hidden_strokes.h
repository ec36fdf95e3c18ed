#pragma once

#include <cstddef>
#include <vector>

#include "hal/image.h"
#include "pipeline/gpu/shader_library.h"

namespace pleinair {

/// What a layer's strokes were for, in a painting at rest.
struct LayerUse {
  std::size_t strokes = 0;
  std::size_t hidden = 0;  ///< strokes of which later ones leave nothing to be seen
};

/// Paints the RGB8 picture as a still for two seconds with the painter's defaults, and counts, from
/// the coarsest layer to the finest. A stroke counts as hidden where the inner parts of later ones
/// (three fifths of their widths, painted opaquely) cover all of its own width: less than is truly
/// hidden, never more. `library` has the shaders of all styles; a GL context is current.
std::vector<LayerUse> strokesInUse(const gpu::ShaderLibrary& library, const hal::Image& picture);

}  // namespace pleinair
