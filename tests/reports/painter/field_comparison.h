#pragma once

#include <vector>

#include "hal/image.h"
#include "pipeline/gpu/shader_library.h"

namespace pleinair::marks {

/// The pyramid's field of an image compared with the global radial-basis interpolation (thesis eq.
/// 12).
struct FieldComparison {
  hal::FrameSize regions;
  std::vector<double> apartRad;  ///< angle between the two directions, region by region
  std::vector<bool> hasEdges;    ///< whether the region has its own edge pixels
  std::size_t edgePixels = 0;
  double pyramidMs = 0.0;  ///< the product, on the GPU: gradient to look-up, all levels
  double oracleMs = 0.0;   ///< the thesis's pyramid on one CPU core, from the gradients on
  /// eq. 12 at the middle of each region, on one CPU core, from the gradients on
  double globalMs = 0.0;
};

/// `image`: RGB8. `sigma` of eq. 12 in px. Call on the thread of a GL context.
FieldComparison compareField(const gpu::ShaderLibrary& library, const hal::Image& image,
                             double sigmaPx);

/// The image in pale colours, with red where the two fields differ: full red at 45 degrees and
/// more.
hal::Image errorMap(const FieldComparison& comparison, const hal::Image& image);

}  // namespace pleinair::marks
