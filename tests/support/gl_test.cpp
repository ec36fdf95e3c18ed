#include "tests/support/gl_test.h"

#include <algorithm>

#include "hal/error.h"
#include "pipeline/gpu/render_target.h"

namespace pleinair::support {
namespace {

/// Reads the one colour attachment of a target on `texture`.
void readPixels(const gpu::Texture& texture, GLenum format, GLenum type, void* destination) {
  const gpu::RenderTarget target({&texture});
  target.beginKeeping();
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, texture.size().width, texture.size().height, format, type, destination);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

std::size_t pixels(const gpu::Texture& texture) {
  return static_cast<std::size_t>(texture.size().pixels());
}

}  // namespace

void GlTest::SetUp() {
  try {
    context_ = std::make_unique<gpu::EglContext>();
  } catch (const hal::Failure& error) {
    GTEST_SKIP() << "needs OpenGL ES 3.1: " << error.what();
  }
}

gpu::Texture textureOf(const hal::ImageView& image) {
  hal::Image rgba({.pixelFormat = hal::PixelFormat::kRgba8, .size = image.format.size});
  const std::size_t channels = image.format.pixelFormat == hal::PixelFormat::kRgba8 ? 4 : 3;
  for (int y = 0; y < image.format.size.height; ++y) {
    const auto in = image.row(0, y);
    const auto out = rgba.row(0, y);
    for (std::size_t x = 0; x < out.size() / 4; ++x) {
      std::ranges::copy(in.subspan(x * channels, 3), out.begin() + static_cast<long>(x) * 4);
      out[x * 4 + 3] = 255;
    }
  }
  gpu::Texture texture(gpu::TextureFormat::kRgba8, image.format.size, gpu::TextureFilter::kLinear);
  texture.upload(rgba.plane(0),
                 rgba.plane(0).size() / static_cast<std::size_t>(image.format.size.height));
  return texture;
}

hal::Image readRgba8(const gpu::Texture& texture) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = texture.size()});
  readPixels(texture, GL_RGBA, GL_UNSIGNED_BYTE, image.plane(0).data());
  return image;
}

std::vector<std::uint32_t> readR32ui(const gpu::Texture& texture) {
  // Integer targets can always be read as four components.
  std::vector<std::uint32_t> four(pixels(texture) * 4);
  readPixels(texture, GL_RGBA_INTEGER, GL_UNSIGNED_INT, four.data());
  std::vector<std::uint32_t> one(pixels(texture));
  for (std::size_t i = 0; i < one.size(); ++i) one[i] = four[i * 4];
  return one;
}

std::vector<float> readRgba32f(const gpu::Texture& texture) {
  std::vector<float> values(pixels(texture) * 4);
  readPixels(texture, GL_RGBA, GL_FLOAT, values.data());
  return values;
}

}  // namespace pleinair::support
