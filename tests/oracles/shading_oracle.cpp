#include "tests/oracles/shading_oracle.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "tests/oracles/raster_oracle.h"

namespace pleinair::oracles {
namespace {

double coded(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

double luminance(const glm::dvec3& rgb) {
  return 0.2126 * rgb.r + 0.7152 * rgb.g + 0.0722 * rgb.b;
}

}  // namespace

double bandIntensity(const glm::dvec3& normal, const scene::Lighting& light) {
  const double facing = std::max(0.0, glm::dot(glm::dvec3(light.towardKey), normal));
  if (!light.bandsAllLight) return facing;
  const double key = luminance(glm::dvec3(light.key)), sky = luminance(glm::dvec3(light.sky));
  const double fromAbove = 0.5 + 0.5 * glm::dot(glm::dvec3(light.up), normal);
  return (key * facing + sky * fromAbove) / (key + sky);
}

glm::dvec3 toonShaded(const glm::dvec3& linearRgb, const glm::dvec3& normal,
                      const scene::Lighting& light) {
  const glm::dvec3 white(light.white), sky(light.sky);
  const double ambientShare = 0.5 * luminance(sky + glm::dvec3(light.ground)) / luminance(white);
  const double deepest =
      light.bandsAllLight ? std::clamp(0.6 * std::pow(ambientShare, 1.0 / 2.2), 0.1, 1.0) : 0.1;
  const double band = 1.0 - (1.0 - toonBand(bandIntensity(normal, light))) * (1.0 - deepest) / 0.9;
  glm::dvec3 result;
  for (int c = 0; c < 3; ++c) {
    const double hue = (sky[c] / luminance(sky)) / (white[c] / luminance(white));
    const double tint = std::clamp(std::pow(hue, 1.0 / 2.2), 0.75, 1.33);
    const double full = coded(std::clamp(linearRgb[c] * white[c], 0.0, 1.0));
    result[c] = band * (band < 1.0 ? std::min(full * tint, 1.0) : full);
  }
  return result;
}

glm::dvec3 smoothShaded(const glm::dvec3& linearRgb, const glm::dvec3& normal,
                        const glm::dvec3& towardViewer, const scene::Lighting& light) {
  const glm::dvec3 toward(light.towardKey), key(light.key);
  const double facing = std::max(0.0, glm::dot(toward, normal));
  const double fromAbove = 0.5 + 0.5 * glm::dot(glm::dvec3(light.up), normal);
  const glm::dvec3 halfway = glm::normalize(toward + towardViewer);
  const double gloss =
      0.04 * (24.0 + 8.0) / 8.0 * std::pow(std::max(0.0, glm::dot(halfway, normal)), 24.0);
  glm::dvec3 sum;
  for (int c = 0; c < 3; ++c) {
    const double ambient =
        fromAbove * double{light.sky[c]} + (1.0 - fromAbove) * double{light.ground[c]};
    sum[c] = linearRgb[c] * (ambient + key[c] * facing) + key[c] * facing * gloss;
  }
  const double most = std::max({1.0, sum.r, sum.g, sum.b});
  return {coded(sum.r / most), coded(sum.g / most), coded(sum.b / most)};
}

}  // namespace pleinair::oracles
