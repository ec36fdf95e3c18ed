#include "pipeline/present/picture_reader.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "pipeline/gpu/ycbcr.h"
#include "pipeline/present/present_shaders.h"

namespace pleinair::present {
namespace {

using hal::FrameFormat;
using hal::FrameSize;
using hal::PixelFormat;

/// As in pack.frag.
enum class Layout { kRgba, kRgb, kGrey, kI420, kNv12, kYuyv };

Layout layoutOf(PixelFormat format) {
  switch (format) {
    case PixelFormat::kRgba8:
      return Layout::kRgba;
    case PixelFormat::kRgb8:
      return Layout::kRgb;
    case PixelFormat::kGrey8:
      return Layout::kGrey;
    case PixelFormat::kI420:
      return Layout::kI420;
    case PixelFormat::kNv12:
      return Layout::kNv12;
    case PixelFormat::kYuyv:
      return Layout::kYuyv;
    default:
      assert(false && "no output takes Bayer");
      return Layout::kRgba;
  }
}

/// The packed texture: a texel holds four bytes; planes lie one below the other.
FrameSize packedSize(const FrameFormat& format) {
  std::size_t widest = 0;
  int rows = 0;
  for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
    widest = std::max(widest, rowBytes(format.pixelFormat, plane, format.size.width));
    rows += planeRows(format.pixelFormat, plane, format.size.height);
  }
  return {static_cast<int>((widest + 3) / 4), rows};
}

/// Luma and chroma as grey, RGB and RGBA outputs need it: full range, so that white stays white.
hal::ColorEncoding encodingOf(const FrameFormat& format) {
  if (isYCbCr(format.pixelFormat)) return format.encoding;
  return {.matrix = hal::ColorMatrix::kBt601, .range = hal::ColorRange::kFull};
}

}  // namespace

PictureReader::PictureReader(const gpu::ShaderLibrary& library, FrameFormat format, int depth)
    : format_(format),
      program_(library.fragmentPass("pipeline/present/shaders/pack.frag")),
      resampler_(library),
      packed_(gpu::TextureFormat::kRgba8, packedSize(format)),
      target_({&packed_}),
      ring_(static_cast<std::size_t>(depth)) {
  assert(depth >= 1);
  const std::size_t bytes = static_cast<std::size_t>(packed_.size().pixels()) * 4;
  for (Slot& slot : ring_) slot.buffer = gpu::Buffer(bytes, gpu::BufferUsage::kReadBack);
}

void PictureReader::pack(const gpu::Texture& picture) {
  const hal::ColorEncoding encoding = encodingOf(format_);
  const gpu::YcbcrConversion ycbcr = gpu::ycbcrConversion(encoding);
  program_.use()
      .texture("picture", picture)
      .set("pictureSize", glm::ivec2(format_.size.width, format_.size.height))
      .set("layoutKind", static_cast<int>(layoutOf(format_.pixelFormat)))
      .set("ycbcrFromRgb", ycbcr.fromRgb)
      .set("ycbcrOffset", ycbcr.offset)
      .set("chromaLeftSited", gpu::isChromaLeftSited(encoding) ? 1 : 0)
      .drawFullscreen(target_);
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
