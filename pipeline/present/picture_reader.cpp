#include "pipeline/present/picture_reader.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <string_view>

#include "pipeline/gpu/ycbcr.h"
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

/// The packed texture: planes lie one below the other.
FrameSize packedSize(const FrameFormat& format) {
  FrameSize size;
  for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
    const FrameSize texels = planeTexels(format, plane);
    size = {std::max(size.width, texels.width), size.height + texels.height};
  }
  return size;
}

/// Luma and chroma as grey, RGB and RGBA outputs need it: full range, so that white stays white.
hal::ColorEncoding encodingOf(const FrameFormat& format) {
  if (isYCbCr(format.pixelFormat)) return format.encoding;
  return {.matrix = hal::ColorMatrix::kBt601, .range = hal::ColorRange::kFull};
}

}  // namespace

PictureReader::PictureReader(const gpu::ShaderLibrary& library, FrameFormat format, int depth)
    : format_(format),
      resampler_(library),
      packed_(gpu::TextureFormat::kRgba8, packedSize(format)),
      target_({&packed_}),
      ring_(static_cast<std::size_t>(depth)) {
  assert(depth >= 1);
  const std::size_t bytes = static_cast<std::size_t>(packed_.size().pixels()) * 4;
  int row = 0;
  for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
    const FrameSize texels = planeTexels(format, plane);
    passes_.push_back({library.fragmentPass(shaderOf(format.pixelFormat, plane)), row, texels});
    row += texels.height;
  }
  for (Slot& slot : ring_) slot.buffer = gpu::Buffer(bytes, gpu::BufferUsage::kReadBack);
}

void PictureReader::pack(const gpu::Texture& picture) {
  const hal::ColorEncoding encoding = encodingOf(format_);
  const gpu::YcbcrConversion ycbcr = gpu::ycbcrConversion(encoding);
  target_.beginDiscarding();
  for (std::size_t plane = 0; plane < passes_.size(); ++plane) {
    PlanePass& pass = passes_[plane];
    pass.program.use()
        .texture("picture", picture)
        .set("ycbcrFromRgb", ycbcr.fromRgb)
        .set("ycbcrOffset", ycbcr.offset)
        .set("chromaLeftSited", gpu::isChromaLeftSited(encoding) ? 1 : 0)
        .set("plane", static_cast<int>(plane))
        .set("firstRow", pass.firstRow)
        .drawArea(target_, {0, pass.firstRow}, pass.texels);
  }
}

void PictureReader::submit(const gpu::Texture& picture) {
  assert(hasRoom());
  pack(resampler_.resample(picture, format_.size));
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

bool PictureReader::take(hal::Image& image, bool wait) {
  if (isEmpty()) return false;
  Slot& slot = ring_[taken_ % ring_.size()];
  if (!slot.copied.passed(wait ? GL_TIMEOUT_IGNORED : 0)) return false;
  if (image.format() != format_) image = hal::Image(format_);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, slot.buffer.name());
  const void* bytes = glMapBufferRange(
      GL_PIXEL_PACK_BUFFER, 0, static_cast<GLsizeiptr>(slot.buffer.sizeBytes()), GL_MAP_READ_BIT);
  assert(bytes != nullptr);
  unpack(static_cast<const std::uint8_t*>(bytes), image);
  glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  ++taken_;
  return true;
}

void PictureReader::unpack(const std::uint8_t* bytes, hal::Image& image) const {
  const std::size_t stride = static_cast<std::size_t>(packed_.size().width) * 4;
  for (int plane = 0; plane < planeCount(format_.pixelFormat); ++plane) {
    const int rows = planeRows(format_.pixelFormat, plane, format_.size.height);
    for (int y = 0; y < rows; ++y) {
      const auto row = image.row(plane, y);
      std::memcpy(row.data(), bytes, row.size());
      bytes += stride;
    }
  }
}

}  // namespace pleinair::present
