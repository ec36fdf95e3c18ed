#pragma once

#include <vector>

#include "hal/image.h"
#include "pipeline/gpu/shader_library.h"

namespace pleinair::marks {

/// The pyramid's field of a picture beside the global radial-basis interpolation's (thesis eq. 12).
struct FieldComparison {
  hal::FrameSize regions;
  std::vector<double> apartRad;  ///< of the two directions, region by region
  std::vector<bool> hasEdges;    ///< whether the region has edge pixels of its own
  std::size_t edgePixels = 0;
  double pyramidMs = 0.0;  ///< ours, on the GPU: gradient to look-up, all levels
  double oracleMs = 0.0;   ///< the thesis's pyramid on one CPU core, from the gradients on
  double globalMs = 0.0;   ///< eq. 12 at the middle of each region, likewise
};

/// `image`: RGB8. σ of eq. 12 in px. The thread of a GL context.
FieldComparison compareField(const gpu::ShaderLibrary& library, const hal::Image& image,
                             double sigmaPx);

/// The picture, paled, with red over it where the two fields differ: full red at 45 degrees and
/// more.
hal::Image errorMap(const FieldComparison& comparison, const hal::Image& image);

}  // namespace pleinair::marks
