#include "pipeline/gpu/texture.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include <fmt/format.h>

#include "pipeline/gpu/gpu_memory.h"

namespace pleinair::gpu {

GlFormat glFormat(TextureFormat format) {
  switch (format) {
    case TextureFormat::kR8:
      return {GL_R8, GL_RED, GL_UNSIGNED_BYTE, 1};
    case TextureFormat::kRg8:
      return {GL_RG8, GL_RG, GL_UNSIGNED_BYTE, 2};
    case TextureFormat::kRgb8:
      return {GL_RGB8, GL_RGB, GL_UNSIGNED_BYTE, 3};
    case TextureFormat::kRgba8:
      return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
    case TextureFormat::kSrgba8:
      return {GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
    case TextureFormat::kRgba16f:
      return {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, 8};
    case TextureFormat::kRg16f:
      return {GL_RG16F, GL_RG, GL_HALF_FLOAT, 4};
    case TextureFormat::kR32f:
      return {GL_R32F, GL_RED, GL_FLOAT, 4};
    case TextureFormat::kRgba32f:
      return {GL_RGBA32F, GL_RGBA, GL_FLOAT, 16};
    case TextureFormat::kR32ui:
      return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4};
    case TextureFormat::kRg32ui:
      return {GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT, 8};
    case TextureFormat::kDepth24:
      return {GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, 4};
  }
  assert(false);
  return {};
}

bool isRenderable(TextureFormat format) {
  // 32-bit floats are not core render targets of OpenGL ES 3.1; compute writes them as images.
  return format != TextureFormat::kRgb8 && format != TextureFormat::kSrgba8 &&
         format != TextureFormat::kR32f && format != TextureFormat::kRgba32f;
}

bool isFilterable(TextureFormat format) {
  switch (format) {
    case TextureFormat::kR8:
    case TextureFormat::kRg8:
    case TextureFormat::kRgb8:
    case TextureFormat::kRgba8:
    case TextureFormat::kSrgba8:
    case TextureFormat::kRgba16f:
    case TextureFormat::kRg16f:
      return true;
    default:
      return false;
  }
}

namespace {

/// Down to a single pixel.
int levelsOf(hal::FrameSize size) {
  return std::bit_width(static_cast<unsigned>(std::max(size.width, size.height)));
}

GLint glWrap(TextureWrap wrap) {
  if (wrap == TextureWrap::kRepeat) return GL_REPEAT;
  return wrap == TextureWrap::kMirror ? GL_MIRRORED_REPEAT : GL_CLAMP_TO_EDGE;
}

}  // namespace

Texture::Texture(TextureFormat format, hal::FrameSize size, TextureFilter filter, TextureWrap wrap)
    : handle_(TextureHandle::make()),
      format_(format),
      size_(size),
      hasLevels_(filter == TextureFilter::kTrilinear) {
  assert(size.width >= 1 && size.height >= 1);
  assert(filter == TextureFilter::kNearest || isFilterable(format));
  glBindTexture(GL_TEXTURE_2D, handle_.get());
  const int levels = hasLevels_ ? levelsOf(size) : 1;
  glTexStorage2D(GL_TEXTURE_2D, levels, glFormat(format).internal, size.width, size.height);
  const GLint mode = filter == TextureFilter::kNearest ? GL_NEAREST : GL_LINEAR;
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
                  hasLevels_ ? GL_LINEAR_MIPMAP_LINEAR : mode);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, mode);
  glBindTexture(GL_TEXTURE_2D, 0);
  setWrap(wrap, wrap);
  checkMemory(fmt::format("a {}x{} picture", size.width, size.height));
}

void Texture::setWrap(TextureWrap across, TextureWrap down) {
  glBindTexture(GL_TEXTURE_2D, handle_.get());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, glWrap(across));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, glWrap(down));
  glBindTexture(GL_TEXTURE_2D, 0);
}

void Texture::upload(std::span<const std::uint8_t> bytes, std::size_t strideBytes) {
  const GlFormat gl = glFormat(format_);
  const auto texelBytes = static_cast<std::size_t>(gl.bytesPerTexel);
  const std::size_t rowBytes = static_cast<std::size_t>(size_.width) * texelBytes;
  assert(format_ != TextureFormat::kDepth24);
  assert(strideBytes >= rowBytes &&
         bytes.size() >= strideBytes * static_cast<std::size_t>(size_.height - 1) + rowBytes);
  glBindTexture(GL_TEXTURE_2D, handle_.get());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  if (strideBytes % texelBytes == 0) {
    glPixelStorei(GL_UNPACK_ROW_LENGTH, static_cast<GLint>(strideBytes / texelBytes));
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size_.width, size_.height, gl.format, gl.type,
                    bytes.data());
  } else {
    // A stride that is no whole number of texels cannot be told to GL: row by row.
    for (int y = 0; y < size_.height; ++y) {
      glTexSubImage2D(GL_TEXTURE_2D, 0, 0, y, size_.width, 1, gl.format, gl.type,
                      bytes.data() + static_cast<std::size_t>(y) * strideBytes);
    }
  }
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  if (hasLevels_) glGenerateMipmap(GL_TEXTURE_2D);
  glBindTexture(GL_TEXTURE_2D, 0);
}

}  // namespace pleinair::gpu
