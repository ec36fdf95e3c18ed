#include "tests/oracles/tensor_oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace pleinair::oracles {
namespace {

const glm::dvec2 kNothingAnywhere(-0.94, -0.342);

std::size_t indexOf(hal::FrameSize size, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
         static_cast<std::size_t>(x);
}

/// Whether `x` is above 0; gradual: 0 to 1, with 1 from `enough` on.
double isSome(double x, double enough, Decision decision) {
  if (decision == Decision::kThesis) return x > 0.0 ? 1.0 : 0.0;
  return glm::smoothstep(0.0, enough, x);
}

/// Bilinear interpolation of four regions around a place, in regions; clamped at the border.
glm::dvec2 bilinear(const std::vector<glm::dvec2>& tensors, hal::FrameSize size, glm::dvec2 at) {
  const glm::dvec2 low = glm::floor(at - 0.5);
  const glm::dvec2 part = at - 0.5 - low;
  const auto texel = [&](int dx, int dy) {
    const int x = std::clamp(static_cast<int>(low.x) + dx, 0, size.width - 1);
    const int y = std::clamp(static_cast<int>(low.y) + dy, 0, size.height - 1);
    return tensors[indexOf(size, x, y)];
  };
  return glm::mix(glm::mix(texel(0, 0), texel(1, 0), part.x),
                  glm::mix(texel(0, 1), texel(1, 1), part.x), part.y);
}

glm::dvec2 gradual(const TensorRegion& own, glm::dvec2 upper) {
  const glm::dvec2 tensor = glm::mix(upper, own.tensor, own.known);
  return glm::mix(upper, tensor, glm::smoothstep(0.02, 0.1, glm::length(tensor)));
}

/// The gradual look-up for all regions of a level.
std::vector<glm::dvec2> resolved(const std::vector<TensorGrid>& pyramid, std::size_t level) {
  const TensorGrid& grid = pyramid[level];
  std::vector<glm::dvec2> above;
  if (level + 1 < pyramid.size()) above = resolved(pyramid, level + 1);
  std::vector<glm::dvec2> tensors;
  for (int y = 0; y < grid.size.height; ++y) {
    for (int x = 0; x < grid.size.width; ++x) {
      const glm::dvec2 upper =
          above.empty() ? kNothingAnywhere
                        : bilinear(above, pyramid[level + 1].size, (glm::dvec2(x, y) + 0.5) / 2.0);
      tensors.push_back(gradual(grid.at(x, y), upper));
    }
  }
  return tensors;
}

}  // namespace

const TensorRegion& TensorGrid::at(int x, int y) const {
  return regions[indexOf(size, x, y)];
}

TensorGrid tensorRegions(const TensorImage& image, int regionPixels, double threshold,
                         Decision decision, double maxLeading) {
  constexpr double kSurePixels = 4.0;
  const double leading = std::min(threshold, maxLeading);
  TensorGrid grid{.size = {(image.size.width + regionPixels - 1) / regionPixels,
                           (image.size.height + regionPixels - 1) / regionPixels},
                  .regions = {}};
  struct Sums {
    glm::dvec2 tensor{0.0};
    double strength = 0.0;
    double weight = 0.0;
    double edges = 0.0;
    double pixels = 0.0;
  };
  std::vector<Sums> sums(static_cast<std::size_t>(grid.size.pixels()));
  for (int y = 0; y < image.size.height; ++y) {
    for (int x = 0; x < image.size.width; ++x) {
      const glm::dvec2 tensor = image.tensors[indexOf(image.size, x, y)];
      const double p = glm::length(tensor);
      const double weight = decision == Decision::kThesis ? (p >= leading ? 1.0 : 0.0)
                                                          : glm::smoothstep(0.6, 1.4, p / leading);
      Sums& sum = sums[indexOf(grid.size, x / regionPixels, y / regionPixels)];
      sum.tensor += weight * tensor;
      sum.strength += weight * p;
      sum.weight += weight;
      sum.edges += p;
      sum.pixels += 1.0;
    }
  }
  for (const Sums& sum : sums) {
    const bool has = sum.strength > 0.0;
    const double sure = std::min(sum.weight / kSurePixels, 1.0);
    grid.regions.push_back({.tensor = has ? sum.tensor / sum.strength : glm::dvec2(0.0),
                            .known = decision == Decision::kThesis ? (has ? 1.0 : 0.0) : sure,
                            .detail = sum.edges / (sum.pixels * threshold)});
  }
  return grid;
}

TensorGrid filledTensors(const TensorGrid& grid, double sigma, Decision decision) {
  TensorGrid filled{.size = grid.size, .regions = {}};
  for (int y = 0; y < grid.size.height; ++y) {
    for (int x = 0; x < grid.size.width; ++x) {
      glm::dvec2 sum(0.0);
      double weights = 0.0;
      for (int v = std::max(0, y - 2); v <= std::min(grid.size.height - 1, y + 2); ++v) {
        for (int u = std::max(0, x - 2); u <= std::min(grid.size.width - 1, x + 2); ++u) {
          const TensorRegion& there = grid.at(u, v);
          const double weight = std::exp(-std::hypot(u - x, v - y) / sigma) * there.known;
          sum += weight * there.tensor;
          weights += weight;
        }
      }
      TensorRegion region = grid.at(x, y);
      const double around = isSome(weights, 0.1, decision);
      const glm::dvec2 value = weights > 1e-4 ? sum / weights : glm::dvec2(0.0);
      region.tensor = glm::mix(value, region.tensor, region.known);
      region.known = std::max(region.known, around * (1.0 - region.known));
      filled.regions.push_back(region);
    }
  }
  return filled;
}

TensorGrid reducedTensors(const TensorGrid& filled, Decision decision) {
  constexpr std::array<double, 4> kKernel{1.0, 3.0, 3.0, 1.0};
  TensorGrid reduced{.size = {(filled.size.width + 1) / 2, (filled.size.height + 1) / 2},
                     .regions = {}};
  for (int y = 0; y < reduced.size.height; ++y) {
    for (int x = 0; x < reduced.size.width; ++x) {
      glm::dvec2 sum(0.0);
      double known = 0.0;
      double detail = 0.0;
      for (int i = 0; i < 16; ++i) {
        const int u = std::clamp(2 * x + i % 4 - 1, 0, filled.size.width - 1);
        const int v = std::clamp(2 * y + i / 4 - 1, 0, filled.size.height - 1);
        const double weight = kKernel.at(static_cast<std::size_t>(i % 4)) *
                              kKernel.at(static_cast<std::size_t>(i / 4)) / 64.0;
        const TensorRegion& there = filled.at(u, v);
        sum += weight * there.known * there.tensor;
        known += weight * there.known;
        detail += weight * there.detail;
      }
      reduced.regions.push_back({.tensor = known > 1e-4 ? sum / known : glm::dvec2(0.0),
                                 .known = isSome(known, 0.1, decision),
                                 .detail = detail});
    }
  }
  return reduced;
}

std::vector<TensorGrid> tensorPyramid(TensorGrid regions, double sigma, Decision decision) {
  std::vector<TensorGrid> levels;
  for (;;) {
    levels.push_back(filledTensors(regions, sigma, decision));
    const hal::FrameSize size = levels.back().size;
    if (size.width == 1 && size.height == 1) return levels;
    regions = reducedTensors(levels.back(), decision);
  }
}

glm::dvec2 lookedUp(const std::vector<TensorGrid>& pyramid, std::size_t level, glm::ivec2 region,
                    Decision decision) {
  if (decision == Decision::kGradual) {
    return resolved(pyramid, level)[indexOf(pyramid[level].size, region.x, region.y)];
  }
  for (std::size_t i = level; i < pyramid.size(); ++i) {
    const int shift = static_cast<int>(i - level);
    const TensorRegion& found = pyramid[i].at(region.x >> shift, region.y >> shift);
    // Tensors that cancel give no direction.
    if (found.known > 0.0 && glm::length(found.tensor) > 1e-6) return found.tensor;
  }
  return kNothingAnywhere;
}

}  // namespace pleinair::oracles
