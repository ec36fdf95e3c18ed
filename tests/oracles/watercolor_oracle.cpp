#include "tests/oracles/watercolor_oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

namespace pleinair::oracles {
namespace {

std::uint32_t pcg(std::uint32_t value) {
  const std::uint32_t state = value * 747796405U + 2891336453U;
  const std::uint32_t word = ((state >> ((state >> 28U) + 4U)) ^ state) * 277803737U;
  return (word >> 22U) ^ word;
}

double unit(std::uint32_t hash) {
  return (hash >> 8U) / 16777216.0;
}

double toLattice(double value) {
  return std::floor(value * 64.0 + 0.5) / 64.0;
}

int cellsAlong(int pixels, int cellSize) {
  return std::max(1, static_cast<int>(std::lround(static_cast<double>(pixels) / cellSize)));
}

std::size_t pixelIndex(const Grid& grid, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.width) +
         static_cast<std::size_t>(x);
}

/// Y', Cb, Cr of ITU-R BT.601-7 §2.5.
glm::dvec3 yuvOf(glm::dvec3 rgb) {
  const double y = 0.299 * rgb.r + 0.587 * rgb.g + 0.114 * rgb.b;
  return {y, (rgb.b - y) / 1.772, (rgb.r - y) / 1.402};
}

/// ∇ of one channel: (|C(x+1,y) − C(x−1,y)| + |C(x,y+1) − C(x,y−1)|) / 2.
double nabla(double right, double left, double below, double above) {
  return (std::abs(right - left) + std::abs(below - above)) / 2.0;
}

glm::dvec3 nabla(const std::array<glm::dvec3, 4>& around) {
  glm::dvec3 result;
  for (int c = 0; c < 3; ++c) {
    result[c] = nabla(around[0][c], around[1][c], around[2][c], around[3][c]);
  }
  return result;
}

double clampedAlong(double value, double home, double middle, double cell, double extent) {
  const double low = std::max({home - cell, middle - cell, 0.0});
  const double high = std::min({home + cell, middle + cell, extent});
  return std::clamp(value, std::ceil(low * 64.0 - 0.01) / 64.0,
                    std::floor(high * 64.0 + 0.01) / 64.0);
}

}  // namespace

Grid gridOf(hal::FrameSize size, int cellSize) {
  return {.columns = cellsAlong(size.width, cellSize),
          .rows = cellsAlong(size.height, cellSize),
          .width = size.width,
          .height = size.height};
}

std::vector<glm::dvec2> seedsAtHome(const Grid& grid, std::uint32_t seed) {
  std::vector<glm::dvec2> seeds;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::uint32_t hash =
          pcg(static_cast<std::uint32_t>(j) + pcg(static_cast<std::uint32_t>(i) + pcg(seed)));
      const double rx = unit(hash) - 0.5;
      const double ry = unit(pcg(hash)) - 0.5;
      seeds.emplace_back(toLattice(grid.cellWidth() * (j + 0.5 + rx)),
                         toLattice(grid.cellHeight() * (i + 0.5 + ry)));
    }
  }
  return seeds;
}

std::vector<std::uint32_t> voronoiLabels(const Grid& grid, const std::vector<glm::dvec2>& seeds) {
  std::vector<std::uint32_t> labels(pixelIndex(grid, 0, grid.height));
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < seeds.size(); ++k) {
        const double dx = seeds[k].x - (x + 0.5);
        const double dy = seeds[k].y - (y + 0.5);
        const double squared = dx * dx + dy * dy;  // exact: multiples of 2⁻¹² below 2²⁸
        if (squared < least) {
          least = squared;
          labels[pixelIndex(grid, x, y)] = static_cast<std::uint32_t>(k);
        }
      }
    }
  }
  return labels;
}

glm::dvec3 pixelAt(const hal::ImageView& image, int x, int y) {
  const std::size_t channels = image.format.pixelFormat == hal::PixelFormat::kRgba8 ? 4 : 3;
  const auto row = image.row(0, std::clamp(y, 0, image.format.size.height - 1));
  const auto at =
      static_cast<std::size_t>(std::clamp(x, 0, image.format.size.width - 1)) * channels;
  return glm::dvec3(row[at], row[at + 1], row[at + 2]) / 255.0;
}

double linearFromSrgb(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

double srgbFromLinear(double linear) {
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

std::vector<CellMean> cellMeans(const Grid& grid, const hal::ImageView& image,
                                const std::vector<std::uint32_t>& labels,
                                const std::vector<glm::dvec2>& seeds) {
  std::vector<CellMean> means(seeds.size());
  std::vector<glm::dvec3> sums(seeds.size(), glm::dvec3(0.0));
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      const std::uint32_t k = labels[pixelIndex(grid, x, y)];
      const glm::dvec3 srgb = pixelAt(image, x, y);
      for (int c = 0; c < 3; ++c) sums[k][c] += linearFromSrgb(srgb[c]);
      ++means[k].pixels;
    }
  }
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    if (means[k].pixels == 0) {
      means[k].srgb = pixelAt(image, static_cast<int>(seeds[k].x), static_cast<int>(seeds[k].y));
      continue;
    }
    for (int c = 0; c < 3; ++c) means[k].srgb[c] = srgbFromLinear(sums[k][c] / means[k].pixels);
  }
  return means;
}

std::vector<double> edgeStrengths(const hal::ImageView& image, double alpha, double beta) {
  std::vector<double> strengths;
  for (int y = 0; y < image.format.size.height; ++y) {
    for (int x = 0; x < image.format.size.width; ++x) {
      const std::array<glm::dvec3, 4> rgb{pixelAt(image, x + 1, y), pixelAt(image, x - 1, y),
                                          pixelAt(image, x, y + 1), pixelAt(image, x, y - 1)};
      const glm::dvec3 ofRgb = nabla(rgb);
      const glm::dvec3 ofYuv = nabla({yuvOf(rgb[0]), yuvOf(rgb[1]), yuvOf(rgb[2]), yuvOf(rgb[3])});
      const double edgeYuv = (1.0 - alpha) * ofYuv[0] + alpha * (ofYuv[1] + ofYuv[2]) / 2.0;
      const double edgeRgb = (ofRgb[0] + ofRgb[1] + ofRgb[2]) / 3.0;
      strengths.push_back(beta * edgeYuv + (1.0 - beta) * edgeRgb);
    }
  }
  return strengths;
}

TwoColours twoColoursOf(const std::vector<glm::dvec3>& colours) {
  const auto lumaOf = [](glm::dvec3 c) { return 0.25 * c.r + 0.625 * c.g + 0.125 * c.b; };
  const auto count = static_cast<double>(colours.size());
  glm::dvec3 mean(0.0);
  for (const glm::dvec3& c : colours) mean += c / count;
  double second = 0.0;
  double third = 0.0;
  glm::dvec3 covariance(0.0);
  for (const glm::dvec3& c : colours) {
    const double apart = lumaOf(c) - lumaOf(mean);
    second += apart * apart / count;
    third += apart * apart * apart / count;
    covariance += apart * (c - mean) / count;
  }
  TwoColours result{.dark = mean, .light = mean, .lumaSpread = std::sqrt(second)};
  if (second <= 0.0) return result;
  // Two points p and 1 − p apart have the skewness (1 − 2p) / √(p (1 − p)).
  const double skewness = third / std::pow(second, 1.5);
  const double p = 0.5 - 0.5 * skewness / std::sqrt(skewness * skewness + 4.0);
  const glm::dvec3 perSpread = covariance / result.lumaSpread;
  result.light = glm::clamp(mean + perSpread * std::sqrt((1.0 - p) / p), 0.0, 1.0);
  result.dark = glm::clamp(mean - perSpread * std::sqrt(p / (1.0 - p)), 0.0, 1.0);
  result.lightShare = p;
  return result;
}

std::vector<glm::dvec2> retiled(const Grid& grid, const std::vector<std::uint32_t>& labels,
                                const std::vector<bool>& edges,
                                const std::vector<glm::dvec2>& seeds,
                                const std::vector<glm::dvec2>& homes, int least) {
  std::vector<glm::dvec2> sums(seeds.size(), glm::dvec2(0.0));
  std::vector<int> counts(seeds.size(), 0);
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      if (!edges[pixelIndex(grid, x, y)]) continue;
      const std::uint32_t k = labels[pixelIndex(grid, x, y)];
      sums[k] += glm::dvec2(x + 0.5, y + 0.5);
      ++counts[k];
    }
  }
  std::vector<glm::dvec2> moved = seeds;
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    if (counts[k] >= least) moved[k] = sums[k] / static_cast<double>(counts[k]);
    const auto column = static_cast<int>(k) % grid.columns;
    const auto row = static_cast<int>(k) / grid.columns;
    moved[k].x = clampedAlong(moved[k].x, homes[k].x, (column + 0.5) * grid.cellWidth(),
                              grid.cellWidth(), grid.width);
    moved[k].y = clampedAlong(moved[k].y, homes[k].y, (row + 0.5) * grid.cellHeight(),
                              grid.cellHeight(), grid.height);
  }
  return moved;
}

}  // namespace pleinair::oracles
