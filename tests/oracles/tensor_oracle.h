#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include <glm/vec2.hpp>

#include "hal/image.h"
#include "pipeline/measure/baselines/edge_tensors.h"

/// A plain CPU version of the tensor field of the thesis's chapter IV (§4.2). What the product's
/// reports compare with, too, is in pipeline/measure/baselines.
namespace pleinair::oracles {

using measure::angleBetween;
using measure::colourTensors;
using measure::edgePercentile;
using measure::gradientTensors;
using measure::RadialBasis;
using measure::radialBasisTensor;
using measure::TensorImage;

/// Whether a region has a tensor: yes or no, as in the thesis, or gradual, so that noise does not
/// switch it.
enum class Decision { kThesis, kGradual };

struct TensorRegion {
  glm::dvec2 tensor{0.0};
  double known = 0.0;   ///< whether it has a tensor; kGradual: its confidence, in [0, 1]
  double detail = 0.0;  ///< mean P, in thresholds
};
struct TensorGrid {
  hal::FrameSize size;
  std::vector<TensorRegion> regions;  ///< row by row
  const TensorRegion& at(int x, int y) const;
};

/// Step 1: the tensors of each region's edge pixels, summed and divided by ΣP. `threshold`: the
/// unit of detail; `maxLeading`: upper limit of the one from which a pixel counts as an edge.
TensorGrid tensorRegions(const TensorImage& image, int regionPixels, double threshold,
                         Decision decision,
                         double maxLeading = std::numeric_limits<double>::infinity());
/// Step 2: a region without a tensor takes the radial-basis value of the 5×5 regions around it,
/// with the weights e^(−d/σ) of eq. 12, σ in regions.
TensorGrid filledTensors(const TensorGrid& grid, double sigma, Decision decision);
/// Step 3: low-pass, then every second region. A region of the result covers four of the level
/// below, so the filter has an even width: (1 3 3 1)², the binomial one about their middle.
TensorGrid reducedTensors(const TensorGrid& filled, Decision decision);
/// Steps 1 to 4: the filled levels, from the finest to 1×1.
std::vector<TensorGrid> tensorPyramid(TensorGrid regions, double sigma, Decision decision);

/// The tensor of a region on a level: that of the first level, from there on, that has one; else
/// (−0.94, −0.342), nearly horizontal strokes. kGradual blends the levels by their confidence,
/// reads coarser levels bilinearly, and skips tensors that cancel.
glm::dvec2 lookedUp(const std::vector<TensorGrid>& pyramid, std::size_t level, glm::ivec2 region,
                    Decision decision);

}  // namespace pleinair::oracles
