#include "tests/oracles/texture_oracle.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pleinair::oracles {
namespace {

double linearOf(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

/// The index of a texel, wrapped into 0 … count − 1.
int wrapped(int texel, int count, scene::TextureEdge edge) {
  if (edge == scene::TextureEdge::kClamp) return std::clamp(texel, 0, count - 1);
  const auto modulo = [](int value, int by) { return (value % by + by) % by; };
  if (edge == scene::TextureEdge::kRepeat) return modulo(texel, count);
  const int there = modulo(texel, 2 * count);
  return there < count ? there : 2 * count - 1 - there;
}

}  // namespace

double srgbOf(double linear) {
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

glm::dvec3 sampleLinear(const scene::ModelTexture& texture, const glm::dvec2& place) {
  const hal::ImageView picture = texture.picture->view();
  const hal::FrameSize size = picture.format.size;
  const double x = place.x * size.width - 0.5;
  const double y = place.y * size.height - 0.5;
  const double left = std::floor(x);
  const double top = std::floor(y);
  glm::dvec3 sum(0.0);
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const double weight =
          (i == 0 ? 1.0 - (x - left) : x - left) * (j == 0 ? 1.0 - (y - top) : y - top);
      const int column = wrapped(static_cast<int>(left) + i, size.width, texture.across);
      const int row = wrapped(static_cast<int>(top) + j, size.height, texture.down);
      const auto texel = picture.row(0, row).subspan(static_cast<std::size_t>(4 * column), 3);
      sum += weight * glm::dvec3(linearOf(texel[0] / 255.0), linearOf(texel[1] / 255.0),
                                 linearOf(texel[2] / 255.0));
    }
  }
  return sum;
}

}  // namespace pleinair::oracles
