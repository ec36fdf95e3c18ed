#include "pipeline/gpu/images/pixel_comparison.h"

#include <cstddef>

#include <fmt/format.h>

#include "pipeline/gpu/render_target.h"

namespace pleinair::gpu {

std::vector<std::uint8_t> pixelsOf(const Texture& texture) {
  constexpr std::size_t kBytesPerPixel = 4;
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(texture.size().pixels()) *
                                   kBytesPerPixel);
  const RenderTarget target({&texture});
  target.beginKeeping();
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, texture.size().width, texture.size().height, GL_RGBA, GL_UNSIGNED_BYTE,
               pixels.data());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return pixels;
}

std::string differenceText(std::span<const std::uint8_t> seen,
                           std::span<const std::uint8_t> right) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < right.size(); ++i) {
    if (i >= seen.size() || seen[i] != right[i]) ++wrong;
  }
  return fmt::format(
      "the GPU reads other pixels than the processor does ({:.1f} % differ)",
      right.empty() ? 0.0 : 100.0 * static_cast<double>(wrong) / static_cast<double>(right.size()));
}

}  // namespace pleinair::gpu
