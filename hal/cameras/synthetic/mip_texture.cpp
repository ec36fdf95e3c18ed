#include "hal/cameras/synthetic/mip_texture.h"

#include <cmath>
#include <cstddef>

#include <glm/common.hpp>

namespace pleinair::hal::synthetic {
namespace {

constexpr int kLevels = 6;
constexpr int kCoarsestTexel = 1 << (kLevels - 1);

int roundUp(int size) {
  return (size + kCoarsestTexel - 1) / kCoarsestTexel * kCoarsestTexel;
}

std::uint16_t mean(unsigned a, unsigned b, unsigned c, unsigned d) {
  return static_cast<std::uint16_t>((a + b + c + d + 2) / 4);
}

MipTexture::Level halved(const MipTexture::Level& fine) {
  MipTexture::Level coarse{fine.width / 2, fine.height / 2, {}};
  coarse.texels.resize(static_cast<std::size_t>(coarse.width) *
                       static_cast<std::size_t>(coarse.height));
  for (int y = 0; y < coarse.height; ++y) {
    const Texel* upper = fine.texels.data() + std::ptrdiff_t{2} * y * fine.width;
    const Texel* lower = upper + fine.width;
    Texel* out = coarse.texels.data() + std::ptrdiff_t{y} * coarse.width;
    for (int x = 0; x < coarse.width; ++x, upper += 2, lower += 2) {
      out[x] = {mean(upper[0].red, upper[1].red, lower[0].red, lower[1].red),
                mean(upper[0].green, upper[1].green, lower[0].green, lower[1].green),
                mean(upper[0].blue, upper[1].blue, lower[0].blue, lower[1].blue),
                mean(upper[0].coverage, upper[1].coverage, lower[0].coverage, lower[1].coverage)};
    }
  }
  return coarse;
}

float linearFromSrgb(float coded) {
  return coded <= 0.04045F ? coded / 12.92F : std::pow((coded + 0.055F) / 1.055F, 2.4F);
}

}  // namespace

Texel packTexel(glm::vec4 linearPremultiplied) {
  const glm::vec4 scaled = glm::clamp(linearPremultiplied, 0.0F, 1.0F) * 65535.0F + 0.5F;
  return {static_cast<std::uint16_t>(scaled.r), static_cast<std::uint16_t>(scaled.g),
          static_cast<std::uint16_t>(scaled.b), static_cast<std::uint16_t>(scaled.a)};
}

glm::vec4 unpackTexel(Texel texel) {
  return glm::vec4(texel.red, texel.green, texel.blue, texel.coverage) / 65535.0F;
}

MipTexture::MipTexture(int minimumWidth, int minimumHeight) {
  Level base{roundUp(minimumWidth), roundUp(minimumHeight), {}};
  base.texels.resize(static_cast<std::size_t>(base.width) * static_cast<std::size_t>(base.height));
  levels_.push_back(std::move(base));
}

void MipTexture::buildLevels() {
  levels_.resize(1);
  levels_.reserve(kLevels);
  while (levels_.size() < kLevels) levels_.push_back(halved(levels_.back()));
}

glm::vec3 linearFromSrgb(std::uint32_t rrggbb) {
  const auto channel = [rrggbb](int shift) {
    return linearFromSrgb(static_cast<float>((rrggbb >> shift) & 0xffU) / 255.0F);
  };
  return {channel(16), channel(8), channel(0)};
}

}  // namespace pleinair::hal::synthetic
