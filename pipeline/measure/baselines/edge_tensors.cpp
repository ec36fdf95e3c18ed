#include "pipeline/measure/baselines/edge_tensors.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace pleinair::measure {
namespace {

std::size_t indexOf(hal::FrameSize size, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
         static_cast<std::size_t>(x);
}

/// Luma, red against green, blue against both.
glm::dvec3 opponentsAt(const hal::ImageView& image, int x, int y) {
  const hal::FrameSize size = image.format.size;
  const std::size_t channels = image.format.pixelFormat == hal::PixelFormat::kRgba8 ? 4 : 3;
  const auto row = image.row(0, std::clamp(y, 0, size.height - 1));
  const auto* px = &row[channels * static_cast<std::size_t>(std::clamp(x, 0, size.width - 1))];
  return glm::dvec3(0.299 * px[0] + 0.587 * px[1] + 0.114 * px[2], px[0] - px[1],
                    px[2] - 0.5 * (px[0] + px[1])) /
         255.0;
}

/// `weights`: of what opponentsAt() gives.
TensorImage weightedTensors(const hal::ImageView& image, const glm::dvec3& weights) {
  TensorImage made{.size = image.format.size, .tensors = {}};
  made.tensors.reserve(static_cast<std::size_t>(made.size.pixels()));
  for (int y = 0; y < made.size.height; ++y) {
    for (int x = 0; x < made.size.width; ++x) {
      const auto i = [&](int dx, int dy) { return weights * opponentsAt(image, x + dx, y + dy); };
      const glm::dvec3 gx = 2.0 * (i(1, 0) - i(-1, 0)) + i(1, 1) - i(-1, 1) + i(1, -1) - i(-1, -1);
      const glm::dvec3 gy = 2.0 * (i(0, 1) - i(0, -1)) + i(1, 1) - i(1, -1) + i(-1, 1) - i(-1, -1);
      const double alike = glm::dot(gx, gx) - glm::dot(gy, gy);
      const double mixed = 2.0 * glm::dot(gx, gy);
      const double theta = 0.5 * std::atan2(mixed, alike);
      made.tensors.push_back(std::sqrt(std::hypot(alike, mixed)) *
                             glm::dvec2(std::cos(2.0 * theta), std::sin(2.0 * theta)));
    }
  }
  return made;
}

struct Edge {
  glm::dvec2 px;
  glm::dvec2 tensor;
};

std::vector<Edge> edgesOf(const TensorImage& image, double threshold) {
  std::vector<Edge> edges;
  for (int y = 0; y < image.size.height; ++y) {
    for (int x = 0; x < image.size.width; ++x) {
      const glm::dvec2 tensor = image.tensors[indexOf(image.size, x, y)];
      if (glm::length(tensor) >= threshold) edges.push_back({glm::dvec2(x, y) + 0.5, tensor});
    }
  }
  return edges;
}

glm::dvec2 interpolated(const std::vector<Edge>& edges, double sigma, RadialBasis form,
                        glm::dvec2 px) {
  glm::dvec2 sum(0.0);
  double weights = 0.0;
  for (const Edge& edge : edges) {
    const double weight = std::exp(-glm::distance(px, edge.px) / sigma);
    sum += weight * edge.tensor;
    weights += weight;
  }
  if (form == RadialBasis::kEq11) return sum;
  return weights > 0.0 ? sum / weights : glm::dvec2(0.0);
}

}  // namespace

TensorImage gradientTensors(const hal::ImageView& image) {
  return weightedTensors(image, {1.0, 0.0, 0.0});
}

TensorImage colourTensors(const hal::ImageView& image) {
  return weightedTensors(image, {1.0, 0.5, 0.5});
}

double edgePercentile(const TensorImage& image, double part) {
  std::vector<double> strengths;
  for (const glm::dvec2& each : image.tensors) strengths.push_back(glm::length(each));
  const auto rank = static_cast<std::ptrdiff_t>(part * static_cast<double>(strengths.size()));
  const auto place =
      strengths.begin() + std::min(rank, static_cast<std::ptrdiff_t>(strengths.size()) - 1);
  std::ranges::nth_element(strengths, place);
  return *place;
}

glm::dvec2 radialBasisTensor(const TensorImage& image, double threshold, double sigma,
                             RadialBasis form, glm::dvec2 px) {
  return interpolated(edgesOf(image, threshold), sigma, form, px);
}

std::vector<glm::dvec2> radialBasisTensors(const TensorImage& image, double threshold, double sigma,
                                           RadialBasis form,
                                           const std::vector<glm::dvec2>& places) {
  const std::vector<Edge> edges = edgesOf(image, threshold);
  std::vector<glm::dvec2> tensors;
  tensors.reserve(places.size());
  for (const glm::dvec2 px : places) tensors.push_back(interpolated(edges, sigma, form, px));
  return tensors;
}

hal::FrameSize regionsOf(hal::FrameSize size, int regionPixels) {
  return {(size.width + regionPixels - 1) / regionPixels,
          (size.height + regionPixels - 1) / regionPixels};
}

std::vector<glm::dvec2> regionMiddles(hal::FrameSize size, int regionPixels) {
  const hal::FrameSize regions = regionsOf(size, regionPixels);
  std::vector<glm::dvec2> middles;
  for (int y = 0; y < regions.height; ++y) {
    for (int x = 0; x < regions.width; ++x) {
      middles.push_back(static_cast<double>(regionPixels) * (glm::dvec2(x, y) + 0.5));
    }
  }
  return middles;
}

std::vector<glm::dvec2> meanPyramidTensors(const TensorImage& image, int regionPixels,
                                           double threshold) {
  struct Level {
    hal::FrameSize size;
    std::vector<glm::dvec2> tensors;  // 0: none
  };
  Level finest{.size = regionsOf(image.size, regionPixels), .tensors = {}};
  finest.tensors.resize(static_cast<std::size_t>(finest.size.pixels()), glm::dvec2(0.0));
  std::vector<double> strengths(finest.tensors.size());
  for (const Edge& edge : edgesOf(image, threshold)) {
    const std::size_t region = indexOf(finest.size, static_cast<int>(edge.px.x) / regionPixels,
                                       static_cast<int>(edge.px.y) / regionPixels);
    finest.tensors[region] += edge.tensor;
    strengths[region] += glm::length(edge.tensor);
  }
  for (std::size_t i = 0; i < strengths.size(); ++i) {
    if (strengths[i] > 0.0) finest.tensors[i] /= strengths[i];
  }
  std::vector<Level> levels{std::move(finest)};
  while (levels.back().size.pixels() > 1) {
    const Level& below = levels.back();
    Level above{.size = regionsOf(below.size, 2), .tensors = {}};
    for (int y = 0; y < above.size.height; ++y) {
      for (int x = 0; x < above.size.width; ++x) {
        glm::dvec2 sum(0.0);
        for (int i = 0; i < 4; ++i) {
          const int u = std::min(2 * x + i % 2, below.size.width - 1);
          const int v = std::min(2 * y + i / 2, below.size.height - 1);
          sum += 0.25 * below.tensors[indexOf(below.size, u, v)];
        }
        above.tensors.push_back(sum);
      }
    }
    levels.push_back(std::move(above));
  }
  constexpr double kNone = 1e-6;
  std::vector<glm::dvec2> found;
  const hal::FrameSize size = levels.front().size;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      glm::dvec2 tensor(0.0);
      for (std::size_t i = 0; i < levels.size() && glm::length(tensor) <= kNone; ++i) {
        tensor = levels[i].tensors[indexOf(levels[i].size, x >> i, y >> i)];
      }
      found.push_back(tensor);
    }
  }
  return found;
}

double angleBetween(glm::dvec2 a, glm::dvec2 b) {
  const double lengths = glm::length(a) * glm::length(b);
  if (lengths <= 0.0) return 0.0;
  return 0.5 * std::acos(std::clamp(glm::dot(a, b) / lengths, -1.0, 1.0));
}

}  // namespace pleinair::measure
