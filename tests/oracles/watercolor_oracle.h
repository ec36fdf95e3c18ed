#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/image.h"

/// Chapter III of the thesis on the CPU, as plainly as it can be said: no shortcut of the shaders
/// is taken here.
namespace pleinair::oracles {

/// A seed and what squared distances to it are lengthened by; or none.
struct Site {
  glm::dvec2 px{0.0};
  double penalty = 0.0;
  bool exists = true;
};

/// The power distance |p − s|² + penalty of a pixel's centre.
double powerDistance(const Site& site, int x, int y);

/// For each pixel the nearest of *all* sites; of equally near ones the lowest.
std::vector<std::uint32_t> voronoiLabels(hal::FrameSize size, const std::vector<Site>& sites);

/// RGBA8 or RGB8 pixel, sRGB-coded, in [0, 1]; coordinates beyond the border give the border's.
glm::dvec3 pixelAt(const hal::ImageView& image, int x, int y);

/// IEC 61966-2-1.
double linearFromSrgb(double srgb);
double srgbFromLinear(double linear);

/// Mean of each cell's pixels in linear light, coded as sRGB; `pixels` 0 where it has none.
struct CellMean {
  glm::dvec3 srgb{0.0};
  int pixels = 0;
};
std::vector<CellMean> cellMeans(const hal::ImageView& image,
                                const std::vector<std::uint32_t>& labels, std::size_t cells);

/// The left side of eq. 4's inequality for each pixel: β Edge_YUV + (1 − β) Edge_RGB.
std::vector<double> edgeStrengths(const hal::ImageView& image, double alpha, double beta);

/// The two colours and their shares (p of the light one) that have the mean, the variance and the
/// third moment of the luma of given colours, and the colours' regression on luma (moment
/// preserving thresholding: Tsai, 1985), with the luma (2 R + 5 G + B) / 8. One colour twice where
/// luma hardly varies. All in [0, 1].
struct TwoColours {
  glm::dvec3 dark{0.0};
  glm::dvec3 light{0.0};
  double lightShare = 0.5;
  double lumaSpread = 0.0;  ///< standard deviation
};
TwoColours twoColoursOf(const std::vector<glm::dvec3>& colours);

/// §3.2.3: the mean of the edge pixels' centres in the seed's cell if they are at least `least`,
/// else where it was.
std::vector<glm::dvec2> retiled(hal::FrameSize size, const std::vector<std::uint32_t>& labels,
                                const std::vector<bool>& edges,
                                const std::vector<glm::dvec2>& seeds, int least);

}  // namespace pleinair::oracles
