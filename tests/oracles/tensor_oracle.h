#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>

#include "hal/image.h"

/// A plain CPU version of the tensor field of the thesis's chapter IV (§4.2).
namespace pleinair::oracles {

/// Each pixel's tensor, row by row: P (cos 2θ, sin 2θ) (eq. 9), θ the gradient's direction, P of
/// luma in [0, 1].
struct TensorImage {
  hal::FrameSize size;
  std::vector<glm::dvec2> tensors;
};

/// Eq. 5-9 of an RGBA8 or RGB8 picture's luma (BT.601, sRGB-coded); clamped at the border.
TensorImage gradientTensors(const hal::ImageView& image);

/// The quantile `part` of P over all pixels, by sorting.
double edgePercentile(const TensorImage& image, double part);

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

/// Step 1: the tensors of each region's edge pixels, summed and divided by ΣP.
TensorGrid tensorRegions(const TensorImage& image, int regionPixels, double threshold,
                         Decision decision);
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

/// Global radial-basis interpolation at a place (px) from all pixels with P ≥ threshold, by eq. 11
/// or by eq. 12, which divides by the weights. σ in px. Zero without an edge.
enum class RadialBasis { kEq11, kEq12 };
glm::dvec2 radialBasisTensor(const TensorImage& image, double threshold, double sigma,
                             RadialBasis form, glm::dvec2 px);

/// The angle between two tensors' directions, in [0, π/2]; their lengths do not matter.
double angleBetween(glm::dvec2 a, glm::dvec2 b);

}  // namespace pleinair::oracles
