#include "pipeline/gpu/images/luma_readback.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <utility>

#include <glm/vec2.hpp>

namespace pleinair::gpu {
namespace {

constexpr std::string_view kShader = "pipeline/gpu/images/shaders/luma_bytes.frag";

}  // namespace

LumaReadback::LumaReadback(const ShaderLibrary& library, GpuTestHook testHook)
    : testHook_(std::move(testHook)),
      programs_{library.fragmentPass(kShader), library.fragmentPass(kShader, {{"YUYV"}}),
                library.fragmentPass(kShader, {{"RGBA"}}),
                library.fragmentPass(kShader, {{"BYTES"}})} {}

Program& LumaReadback::programOf(hal::PixelFormat format) {
  switch (format) {
    case hal::PixelFormat::kYuyv:
      return programs_[1];
    case hal::PixelFormat::kRgba8:
      return programs_[2];
    case hal::PixelFormat::kRgb8:
      return programs_[3];
    default:
      return programs_[0];
  }
}

void LumaReadback::prepare(hal::FrameSize size) {
  if (size_ == size) return;
  size_ = {};  // stays so where there is no memory
  Texture packed(TextureFormat::kRgba8, {(size.width + 3) / 4, size.height});
  target_ = RenderTarget({&packed});
  packed_ = std::move(packed);
  buffer_ = Buffer(static_cast<std::size_t>(packed_.size().pixels()) * 4, BufferUsage::kReadBack);
  size_ = size;
}

void LumaReadback::begin(const hal::FrameFormat& format, std::span<const Texture> planes) {
  assert(canRead(format.pixelFormat));
  prepare(format.size);
  programOf(format.pixelFormat)
      .use()
      .texture("plane0", planes.front())
      .set("frameSize", glm::ivec2(size_.width, size_.height))
      .drawFullscreen(target_);
  target_.beginKeeping();
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer_.name());
  glReadPixels(0, 0, packed_.size().width, packed_.size().height, GL_RGBA, GL_UNSIGNED_BYTE,
               nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  copied_ = Fence::insert();
}

hal::Answer LumaReadback::finish(hal::Image& luma, hal::Duration limit) {
  const hal::Answer isCopied = copied_.passed(testHook_, limit);
  if (isCopied.hasError() || !isCopied.isYes()) return isCopied;
  const hal::FrameFormat format{.pixelFormat = hal::PixelFormat::kGrey8, .size = size_};
  if (luma.format() != format) luma = hal::Image(format);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer_.name());
  const auto* const bytes = static_cast<const std::uint8_t*>(glMapBufferRange(
      GL_PIXEL_PACK_BUFFER, 0, static_cast<GLsizeiptr>(buffer_.sizeBytes()), GL_MAP_READ_BIT));
  const auto stride = static_cast<std::size_t>(packed_.size().width) * 4;
  for (int y = 0; bytes != nullptr && y < size_.height; ++y) {
    const auto row = luma.row(0, y);
    std::copy_n(bytes + static_cast<std::size_t>(y) * stride, row.size(), row.begin());
  }
  const bool isIntact = bytes != nullptr && glUnmapBuffer(GL_PIXEL_PACK_BUFFER) == GL_TRUE;
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  if (!isIntact) return tl::unexpected(gpuLost("a frame's luma cannot be read back", GL_NO_ERROR));
  return true;
}

}  // namespace pleinair::gpu
