#include "tests/oracles/watercolor_oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

namespace pleinair::oracles {
namespace {

std::size_t pixelIndex(hal::FrameSize size, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
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

}  // namespace

double powerDistance(const Site& site, int x, int y) {
  const double dx = site.px.x - (x + 0.5);
  const double dy = site.px.y - (y + 0.5);
  return dx * dx + dy * dy + site.penalty;  // exact: multiples of 2⁻¹² below 2²⁸
}

std::vector<std::uint32_t> voronoiLabels(hal::FrameSize size, const std::vector<Site>& sites) {
  std::vector<std::uint32_t> labels(pixelIndex(size, 0, size.height));
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < sites.size(); ++k) {
        if (!sites[k].exists) continue;
        const double away = powerDistance(sites[k], x, y);
        if (away < least) {
          least = away;
          labels[pixelIndex(size, x, y)] = static_cast<std::uint32_t>(k);
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

std::vector<CellMean> cellMeans(const hal::ImageView& image,
                                const std::vector<std::uint32_t>& labels, std::size_t cells) {
  std::vector<CellMean> means(cells);
  std::vector<glm::dvec3> sums(cells, glm::dvec3(0.0));
  for (int y = 0; y < image.format.size.height; ++y) {
    for (int x = 0; x < image.format.size.width; ++x) {
      const std::uint32_t k = labels[pixelIndex(image.format.size, x, y)];
      const glm::dvec3 srgb = pixelAt(image, x, y);
      for (int c = 0; c < 3; ++c) sums[k][c] += linearFromSrgb(srgb[c]);
      ++means[k].pixels;
    }
  }
  for (std::size_t k = 0; k < cells; ++k) {
    for (int c = 0; c < 3 && means[k].pixels > 0; ++c) {
      means[k].srgb[c] = srgbFromLinear(sums[k][c] / means[k].pixels);
    }
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
  // Two points with weights p and 1 − p have the skewness (1 − 2p) / √(p (1 − p)).
  const double skewness = third / std::pow(second, 1.5);
  const double p = 0.5 - 0.5 * skewness / std::sqrt(skewness * skewness + 4.0);
  const glm::dvec3 perSpread = covariance / result.lumaSpread;
  result.light = glm::clamp(mean + perSpread * std::sqrt((1.0 - p) / p), 0.0, 1.0);
  result.dark = glm::clamp(mean - perSpread * std::sqrt(p / (1.0 - p)), 0.0, 1.0);
  result.lightShare = p;
  return result;
}

std::vector<glm::dvec2> retiled(hal::FrameSize size, const std::vector<std::uint32_t>& labels,
                                const std::vector<bool>& edges,
                                const std::vector<glm::dvec2>& seeds, int least) {
  std::vector<glm::dvec2> sums(seeds.size(), glm::dvec2(0.0));
  std::vector<int> counts(seeds.size(), 0);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (!edges[pixelIndex(size, x, y)]) continue;
      const std::uint32_t k = labels[pixelIndex(size, x, y)];
      sums[k] += glm::dvec2(x + 0.5, y + 0.5);
      ++counts[k];
    }
  }
  std::vector<glm::dvec2> moved = seeds;
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    if (counts[k] >= least) moved[k] = sums[k] / static_cast<double>(counts[k]);
  }
  return moved;
}

}  // namespace pleinair::oracles
