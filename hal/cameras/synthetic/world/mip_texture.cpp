#include "hal/cameras/synthetic/world/mip_texture.h"

#include <algorithm>
#include <cstddef>

namespace pleinair::hal::synthetic {
namespace {

constexpr std::size_t kMaxLevels = 9;
constexpr int kSmallestSide = 2;  // the sampler reads texels in pairs

std::vector<Texel> texelsFor(int width, int height) {
  return std::vector<Texel>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
}

MipTexture::Level halved(const MipTexture::Level& fine) {
  MipTexture::Level coarse{std::max((fine.width + 1) / 2, kSmallestSide),
                           std::max((fine.height + 1) / 2, kSmallestSide),
                           {}};
  coarse.texels = texelsFor(coarse.width, coarse.height);
  const auto texel = [&fine](int x, int y) {
    return linearRgbOf(fine.texels[static_cast<std::size_t>(std::min(y, fine.height - 1)) *
                                       static_cast<std::size_t>(fine.width) +
                                   static_cast<std::size_t>(std::min(x, fine.width - 1))]);
  };
  Texel* out = coarse.texels.data();
  for (int y = 0; y < 2 * coarse.height; y += 2) {
    for (int x = 0; x < 2 * coarse.width; x += 2) {
      *out++ = codedTexel((texel(x, y) + texel(x + 1, y) + texel(x, y + 1) + texel(x + 1, y + 1)) *
                          0.25F);
    }
  }
  return coarse;
}

}  // namespace

MipTexture::MipTexture(int width, int height) {
  const int w = std::max(width, kSmallestSide);
  const int h = std::max(height, kSmallestSide);
  levels_.push_back({w, h, texelsFor(w, h)});
}

void MipTexture::buildLevels() {
  levels_.resize(1);
  levels_.reserve(kMaxLevels);
  while (levels_.size() < kMaxLevels &&
         std::max(levels_.back().width, levels_.back().height) > kSmallestSide) {
    levels_.push_back(halved(levels_.back()));
  }
}

}  // namespace pleinair::hal::synthetic
