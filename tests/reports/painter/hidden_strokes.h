#pragma once

#include <cstddef>
#include <vector>

#include "hal/image.h"
#include "pipeline/gpu/programs/shader_library.h"

namespace pleinair {

/// The visible share of a layer's strokes, in a painting at rest.
struct LayerUse {
  std::size_t strokes = 0;
  std::size_t hidden = 0;  ///< strokes that later ones cover completely
};

/// Paints the RGB8 image as a static one for two seconds with the painter's defaults, and counts
/// from the coarsest layer to the finest. A stroke counts as hidden if the inner parts of later
/// ones (three fifths of their widths, painted opaquely) cover its whole width: a lower bound.
/// `library` has the shaders of all styles; a GL context is current.
std::vector<LayerUse> strokesInUse(const gpu::ShaderLibrary& library, const hal::Image& picture);

}  // namespace pleinair
