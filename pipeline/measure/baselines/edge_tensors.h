#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>

#include "hal/image.h"

namespace pleinair::measure {

// Plain versions of what the thesis compares its tensor pyramid with (§4.2, §6.1), on one processor
// core.

/// Each pixel's tensor, row by row: P (cos 2θ, sin 2θ) (eq. 9), θ the direction in which colours
/// differ most; P: of grey pictures, the gradient of luma in [0, 1].
struct TensorImage {
  hal::FrameSize size;
  std::vector<glm::dvec2> tensors;
};

/// Eq. 5-9 of an RGBA8 or RGB8 picture's luma (BT.601, sRGB-coded); clamped at the border.
TensorImage gradientTensors(const hal::ImageView& image);

/// The same of its colours, as the painter has them: of luma and, at half its weight, of the
/// differences of red and green, and of blue and both. θ and P² are the direction and the
/// difference of the eigenvalues of their summed squares (Di Zenzo, 1986).
TensorImage colourTensors(const hal::ImageView& image);

/// The quantile `part` of P over all pixels, by sorting.
double edgePercentile(const TensorImage& image, double part);

/// Global radial-basis interpolation at a place (px) from all pixels with P ≥ threshold, by eq. 11
/// or by eq. 12, which divides by the weights. σ in px. Zero without an edge.
enum class RadialBasis { kEq11, kEq12 };
glm::dvec2 radialBasisTensor(const TensorImage& image, double threshold, double sigma,
                             RadialBasis form, glm::dvec2 px);

/// The same at many places: the edge pixels are collected once.
std::vector<glm::dvec2> radialBasisTensors(const TensorImage& image, double threshold, double sigma,
                                           RadialBasis form, const std::vector<glm::dvec2>& places);

/// The middles of square regions, row by row, px; those at the right and lower border may be cut.
std::vector<glm::dvec2> regionMiddles(hal::FrameSize size, int regionPixels);
hal::FrameSize regionsOf(hal::FrameSize size, int regionPixels);

/// The pyramid that §6.1.2 proposes for the GPU: regions' tensors (those of their edge pixels, over
/// ΣP), each level the mean of 2×2 of the level below, without the interpolation among 5×5 regions
/// and without a low-pass filter. Gives each region's tensor, that of the first level with one.
std::vector<glm::dvec2> meanPyramidTensors(const TensorImage& image, int regionPixels,
                                           double threshold);

/// The angle between two tensors' directions, in [0, π/2]; their lengths do not matter.
double angleBetween(glm::dvec2 a, glm::dvec2 b);

}  // namespace pleinair::measure
