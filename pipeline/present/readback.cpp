#include "pipeline/present/readback.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "hal/error.h"
#include "pipeline/gpu/frames/ycbcr.h"
#include "pipeline/gpu/images/aspect_fill.h"
#include "pipeline/present/present_shaders.h"

namespace pleinair::present {
namespace {

using hal::FrameFormat;
using hal::FrameSize;
using hal::PixelFormat;

/// The shader that packs a plane. One each: the software rasteriser runs every branch of a shared
/// one.
std::string_view shaderOf(PixelFormat format, int plane) {
  switch (format) {
    case PixelFormat::kRgba8:
      return "pipeline/present/shaders/pack_rgba.frag";
    case PixelFormat::kRgb8:
      return "pipeline/present/shaders/pack_rgb.frag";
    case PixelFormat::kYuyv:
      return "pipeline/present/shaders/pack_yuyv.frag";
    case PixelFormat::kI420:
      if (plane > 0) return "pipeline/present/shaders/pack_i420_chroma.frag";
      break;
    case PixelFormat::kNv12:
      if (plane > 0) return "pipeline/present/shaders/pack_nv12_chroma.frag";
      break;
    default:
      assert(format == PixelFormat::kGrey8 && "no output takes Bayer");
      break;
  }
  return "pipeline/present/shaders/pack_luma.frag";
}

/// The packed texels of a plane, four bytes each.
FrameSize planeTexels(const FrameFormat& format, int plane) {
  const std::size_t bytes = rowBytes(format.pixelFormat, plane, format.size.width);
  return {static_cast<int>((bytes + 3) / 4),
          planeRows(format.pixelFormat, plane, format.size.height)};
}

/// Luma and chroma as grey, RGB and RGBA outputs need it: full range, so that white stays white.
hal::ColorEncoding encodingOf(const FrameFormat& format) {
  if (isYCbCr(format.pixelFormat)) return format.encoding;
  return {.matrix = hal::ColorMatrix::kBt601, .range = hal::ColorRange::kFull};
}

hal::Error unreadable(FrameSize size) {
  return {.kind = hal::ErrorKind::kDeviceLost,
          .subject = "GPU",
          .problem = "cannot read a picture of " + std::to_string(size.width) + "x" +
                     std::to_string(size.height) + ": no memory, or the GPU is lost",
          .remedy = "paint smaller, or see the kernel's log and start again",
          .domain = hal::ErrorDomain::kGl};
}

/// Where a plane begins in the packed texture: below luma, Cr of I420 beside its Cb, so that the
/// texture stays within 1.5 times the picture's height.
glm::ivec2 planeOrigin(const FrameFormat& format, int plane) {
  if (plane == 0) return {0, 0};
  return {plane == 1 ? 0 : planeTexels(format, 1).width, planeTexels(format, 0).height};
}

}  // namespace

FrameSize Readback::packedSize(const FrameFormat& format) {
  FrameSize size;
  for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
    const FrameSize texels = planeTexels(format, plane);
    const glm::ivec2 origin = planeOrigin(format, plane);
    size = {std::max(size.width, origin.x + texels.width),
            std::max(size.height, origin.y + texels.height)};
  }
  return size;
}

Readback::Readback(const gpu::ShaderLibrary& library, FrameFormat format, int depth,
                   gpu::GpuTestHook testHook, int quarterTurns)
    : format_(format),
      quarterTurns_(quarterTurns),
      testHook_(std::move(testHook)),
      resampler_(library),
      packed_(gpu::TextureFormat::kRgba8, packedSize(format)),
      target_({&packed_}),
      ring_(static_cast<std::size_t>(depth)) {
  assert(depth >= 1);
  assert(quarterTurns == 0 || format.pixelFormat == PixelFormat::kRgba8);
  const std::size_t bytes = static_cast<std::size_t>(packed_.size().pixels()) * 4;
  for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
    passes_.push_back({library.fragmentPass(shaderOf(format.pixelFormat, plane)),
                       planeOrigin(format, plane), planeTexels(format, plane)});
  }
  for (Slot& slot : ring_) slot.buffer = gpu::Buffer(bytes, gpu::BufferUsage::kReadBack);
}

void Readback::warmUp(FrameSize pictureSize) {
  assert(isEmpty());
  submit(gpu::Texture(gpu::TextureFormat::kRgba8, pictureSize, gpu::TextureFilter::kLinear));
  hal::Image dropped;
  hal::orThrow(wait(dropped));
}

void Readback::pack(const gpu::Texture& picture) {
  const hal::ColorEncoding encoding = encodingOf(format_);
  const gpu::YcbcrConversion ycbcr = gpu::ycbcrConversion(encoding);
  target_.beginDiscarding();
  for (std::size_t plane = 0; plane < passes_.size(); ++plane) {
    PlanePass& pass = passes_[plane];
    pass.program.use()
        .texture("picture", picture)
        .set("ycbcrFromRgb", ycbcr.fromRgb)
        .set("ycbcrOffset", ycbcr.offset)
        .set("chromaLeftSited", gpu::isChromaLeftSited(encoding) ? 1 : 0);
    if (pass.program.hasUniform("plane")) pass.program.set("plane", static_cast<int>(plane));
    if (pass.program.hasUniform("origin")) pass.program.set("origin", pass.origin);
    if (pass.program.hasUniform("quarterTurns")) pass.program.set("quarterTurns", quarterTurns_);
    pass.program.drawArea(target_, pass.origin, pass.texels);
  }
}

FrameSize Readback::unturnedSize() const {
  const FrameSize size = format_.size;
  return quarterTurns_ % 2 == 0 ? size : FrameSize{size.height, size.width};
}

void Readback::submit(const gpu::Texture& picture, FrameSize fullSize) {
  assert(hasRoom());
  const glm::dvec2 pixelsOfFull = glm::dvec2(picture.size().width, picture.size().height) /
                                  glm::dvec2(fullSize.width, fullSize.height);
  const FrameSize size = unturnedSize();
  pack(resampler_.resample(
      picture, size, gpu::aspectFill(fullSize, size).withPixels(pixelsOfFull, glm::dvec2(1.0))));
  Slot& slot = ring_[submitted_ % ring_.size()];
  target_.beginKeeping();
  glBindBuffer(GL_PIXEL_PACK_BUFFER, slot.buffer.name());
  glReadPixels(0, 0, packed_.size().width, packed_.size().height, GL_RGBA, GL_UNSIGNED_BYTE,
               nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  slot.copied = gpu::Fence::insert();
  ++submitted_;
}

hal::Answer Readback::poll(hal::Image& image) {
  if (isEmpty()) return false;
  const hal::Answer isReady = isReadyWithin(hal::Duration::zero());
  return !isReady.hasError() && isReady.isYes() ? copyOldest(image) : isReady;
}

hal::Answer Readback::wait(hal::Image& image) {
  if (isEmpty()) return false;
  const auto copied = ring_[taken_ % ring_.size()].copied.wait(testHook_);
  if (!copied) return tl::unexpected(copied.error());
  return copyOldest(image);
}

hal::Answer Readback::isReadyWithin(hal::Duration limit) const {
  assert(!isEmpty());
  return ring_[taken_ % ring_.size()].copied.passed(testHook_, limit);
}

hal::Answer Readback::copyOldest(hal::Image& image) {
  const Slot& slot = ring_[taken_ % ring_.size()];
  if (image.format() != format_) image = hal::Image(format_);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, slot.buffer.name());
  const void* bytes = glMapBufferRange(
      GL_PIXEL_PACK_BUFFER, 0, static_cast<GLsizeiptr>(slot.buffer.sizeBytes()), GL_MAP_READ_BIT);
  if (bytes != nullptr) unpack(static_cast<const std::uint8_t*>(bytes), image);
  const bool isIntact = bytes != nullptr && glUnmapBuffer(GL_PIXEL_PACK_BUFFER) == GL_TRUE;
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  if (!isIntact) return tl::unexpected(unreadable(format_.size));
  ++taken_;
  return true;
}

void Readback::unpack(const std::uint8_t* bytes, hal::Image& image) const {
  const std::size_t stride = static_cast<std::size_t>(packed_.size().width) * 4;
  for (int plane = 0; plane < planeCount(format_.pixelFormat); ++plane) {
    const glm::ivec2 origin = planeOrigin(format_, plane);
    const std::uint8_t* from = bytes + static_cast<std::size_t>(origin.y) * stride +
                               static_cast<std::size_t>(origin.x) * 4;
    const int rows = planeRows(format_.pixelFormat, plane, format_.size.height);
    for (int y = 0; y < rows; ++y, from += stride) {
      const auto row = image.row(plane, y);
      std::memcpy(row.data(), from, row.size());
    }
  }
}

}  // namespace pleinair::present
