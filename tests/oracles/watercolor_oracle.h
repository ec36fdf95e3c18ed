#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/image.h"

/// Chapter III of the thesis on the CPU, as plainly as it can be said: no shortcut of the shaders
/// is taken here.
namespace pleinair::oracles {

/// The grid: n columns and m rows over W×H.
struct Grid {
  int columns = 1;
  int rows = 1;
  int width = 1;
  int height = 1;
  double cellWidth() const { return static_cast<double>(width) / columns; }
  double cellHeight() const { return static_cast<double>(height) / rows; }
};

/// m and n of about one cell per cellSize² px.
Grid gridOf(hal::FrameSize size, int cellSize);

/// Eq. 1 with R_x, R_y in [-½, ½) by the documented hash; to the nearest 1/64 px.
std::vector<glm::dvec2> seedsAtHome(const Grid& grid, std::uint32_t seed);

/// For each pixel the index of the nearest of *all* seeds; of equally near ones the lowest.
std::vector<std::uint32_t> voronoiLabels(const Grid& grid, const std::vector<glm::dvec2>& seeds);

/// RGBA8 or RGB8 pixel, sRGB-coded, in [0, 1]; coordinates beyond the border give the border's.
glm::dvec3 pixelAt(const hal::ImageView& image, int x, int y);

/// IEC 61966-2-1.
double linearFromSrgb(double srgb);
double srgbFromLinear(double linear);

/// Mean of each cell's pixels in linear light, coded as sRGB; `pixels` 0 where it has none, and the
/// colour under its seed then.
struct CellMean {
  glm::dvec3 srgb{0.0};
  int pixels = 0;
};
std::vector<CellMean> cellMeans(const Grid& grid, const hal::ImageView& image,
                                const std::vector<std::uint32_t>& labels,
                                const std::vector<glm::dvec2>& seeds);

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
/// else where it was; never more than a cell from home nor from the cell's middle, and in the
/// picture, these bounds rounded inwards to 1/64 px.
std::vector<glm::dvec2> retiled(const Grid& grid, const std::vector<std::uint32_t>& labels,
                                const std::vector<bool>& edges,
                                const std::vector<glm::dvec2>& seeds,
                                const std::vector<glm::dvec2>& homes, int least);

}  // namespace pleinair::oracles
