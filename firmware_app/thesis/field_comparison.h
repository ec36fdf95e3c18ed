#pragma once

#include <cstddef>
#include <vector>

#include "hal/image.h"
#include "pipeline/gpu/programs/shader_library.h"

namespace pleinair::app {

/// The painter's tensor field of an image, beside the thesis's alternatives: global radial-basis
/// interpolation (eq. 11, 12), and the pyramid of 2×2 means (§6.1.2).
struct FieldComparison {
  hal::FrameSize regions;             ///< of 8×8 px
  std::vector<double> apartRad;       ///< from eq. 12, region by region
  std::vector<double> meansApartRad;  ///< of the pyramid of 2×2 means from eq. 12
  std::vector<bool> hasEdges;         ///< whether the region has its own edge pixels
  std::size_t edgePixels = 0;
  double holesPercent = 0.0;  ///< regions where eq. 11 is below a thousandth of its largest length
  double pyramidMs = 0.0;     ///< the product, on the GPU: gradient to look-up, all levels
  double meansMs = 0.0;       ///< 2×2 means on one core, from the gradients on
  double globalMs = 0.0;      ///< eq. 12 at the middle of each region, the same
};

/// `image`: RGB8. `sigma` of eq. 12 in px. `library` has gpu::marksShaders(), gpu::sceneShaders()
/// and gpu::gpuShaders(). Waits for the GPU. On the thread of a GL context.
FieldComparison compareField(const gpu::ShaderLibrary& library, const hal::Image& image,
                             double sigmaPx, int runs);

/// The quantile `part` of those angles, in degrees, over the regions whose `hasEdges` is `own`.
double degreesAt(const FieldComparison& comparison, const std::vector<double>& apartRad, bool own,
                 double part);

/// The image in pale colours, with red where the two fields differ: full red at 45 degrees and
/// more.
hal::Image errorMap(const FieldComparison& comparison, const hal::Image& image);

}  // namespace pleinair::app
