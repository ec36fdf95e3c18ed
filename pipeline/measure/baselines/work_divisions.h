#pragma once

#include <string>
#include <vector>

#include "hal/image.h"
#include "pipeline/gpu/programs/shader_library.h"

namespace pleinair::measure {

/// One of the six ways in which thesis §6.1.2 divides the work on tensors: an invocation for each
/// row, column or pixel, which reads from a buffer ("global memory") or a texture.
struct WorkDivision {
  std::string name;         ///< "row, buffer"
  double gradientMs = 0.0;  ///< the initial tensors of all pixels (eq. 5-9): median
  double levelMs = 0.0;     ///< the next level of the pyramid, means of 2×2 tensors: median
  double apart = 0.0;       ///< largest difference of a tensor's component from the processor's
};

/// Times the six ways on an image (RGB8), `runs` times each, waiting for the GPU. `library` has
/// gpu::baselinesShaders() and gpu::gpuShaders(). On the thread of a GL context; throws
/// hal::Failure if GPU memory runs out.
std::vector<WorkDivision> timeWorkDivisions(const gpu::ShaderLibrary& library,
                                            const hal::Image& image, int runs);

}  // namespace pleinair::measure
