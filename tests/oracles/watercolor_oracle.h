#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/image.h"

/// A plain CPU version of the thesis's chapter III, without any of the shaders' shortcuts.
namespace pleinair::oracles {

/// A seed and the penalty added to squared distances to it; or no seed.
struct Site {
  glm::dvec2 px{0.0};
  double penalty = 0.0;
  bool exists = true;
};

/// The power distance |p − s|² + penalty of a pixel's centre.
double powerDistance(const Site& site, int x, int y);

/// For each pixel the nearest of *all* sites; of equally near ones the lowest wins.
std::vector<std::uint32_t> voronoiLabels(hal::FrameSize size, const std::vector<Site>& sites);

/// The colour of an RGBA8 or RGB8 pixel, sRGB-coded, in [0, 1]; coordinates are clamped to the
/// border.
glm::dvec3 pixelAt(const hal::ImageView& image, int x, int y);

/// Linear light of an sRGB level (IEC 61966-2-1).
double linearFromSrgb(double srgb);
double srgbFromLinear(double linear);

/// The mean of each cell's pixels in linear light, coded as sRGB; `pixels` is 0 for an empty cell.
struct CellMean {
  glm::dvec3 srgb{0.0};
  int pixels = 0;
};
std::vector<CellMean> cellMeans(const hal::ImageView& image,
                                const std::vector<std::uint32_t>& labels, std::size_t cells);

/// The left side of eq. 4's inequality for each pixel: β Edge_YUV + (1 − β) Edge_RGB.
std::vector<double> edgeStrengths(const hal::ImageView& image, double alpha, double beta);

/// The two colours and their shares (p of the light one) that preserve the mean, the variance and
/// the third moment of the luma of the given colours, and the colours' regression on luma
/// (moment-preserving thresholding: Tsai, 1985), with the luma (2 R + 5 G + B) / 8. Both colours
/// are the same if luma hardly varies. All in [0, 1].
struct TwoColours {
  glm::dvec3 dark{0.0};
  glm::dvec3 light{0.0};
  double lightShare = 0.5;
  double lumaSpread = 0.0;  ///< standard deviation
};
TwoColours twoColoursOf(const std::vector<glm::dvec3>& colours);

/// §3.2.3: the mean of the edge pixels' centres in the seed's cell if there are at least `least`,
/// else its old place.
std::vector<glm::dvec2> retiled(hal::FrameSize size, const std::vector<std::uint32_t>& labels,
                                const std::vector<bool>& edges,
                                const std::vector<glm::dvec2>& seeds, int least);

}  // namespace pleinair::oracles
