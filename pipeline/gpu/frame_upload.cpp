#include "pipeline/gpu/frame_upload.h"

#include <cassert>

#include "pipeline/gpu/cover_fit.h"

namespace pleinair::gpu {
namespace {

using hal::FrameSize;
using hal::PixelFormat;

/// As in camera_picture.frag.
enum class Layout { kRgb, kGrey, kNv12, kI420, kYuyv, kBayer };

Layout layoutOf(PixelFormat format) {
  switch (format) {
    case PixelFormat::kGrey8:
      return Layout::kGrey;
    case PixelFormat::kRgb8:
    case PixelFormat::kRgba8:
      return Layout::kRgb;
    case PixelFormat::kYuyv:
      return Layout::kYuyv;
    case PixelFormat::kNv12:
      return Layout::kNv12;
    case PixelFormat::kI420:
      return Layout::kI420;
    default:
      return Layout::kBayer;
  }
}

struct PlaneTexture {
  TextureFormat format;
  FrameSize size;
};

PlaneTexture planeTexture(const hal::FrameFormat& format, int plane) {
  const FrameSize full = format.size;
  const FrameSize half{(full.width + 1) / 2, (full.height + 1) / 2};
  switch (format.pixelFormat) {
    case PixelFormat::kRgb8:
      return {TextureFormat::kRgb8, full};
    case PixelFormat::kRgba8:
      return {TextureFormat::kRgba8, full};
    case PixelFormat::kYuyv:
      return {TextureFormat::kRgba8, {half.width, full.height}};
    case PixelFormat::kNv12:
      if (plane == 1) return {TextureFormat::kRg8, half};
      return {TextureFormat::kR8, full};
    case PixelFormat::kI420:
      return {TextureFormat::kR8, plane == 0 ? full : half};
    default:
      return {TextureFormat::kR8, full};
  }
}

struct YuvConversion {
  glm::mat3 toRgb;
  glm::vec3 offset;
};

/// From the luma weights of the red and blue primaries: ITU-R BT.601-7 §2.5, BT.709-6 §3.
YuvConversion yuvConversion(hal::ColorEncoding encoding) {
  const bool is709 = encoding.matrix == hal::ColorMatrix::kBt709;
  const float kr = is709 ? 0.2126F : 0.299F;
  const float kb = is709 ? 0.0722F : 0.114F;
  const float kg = 1.0F - kr - kb;
  const bool limited = encoding.range == hal::ColorRange::kLimited;
  const float lumaScale = limited ? 255.0F / 219.0F : 1.0F;
  const float chromaScale = limited ? 255.0F / 224.0F : 1.0F;
  const float redFromV = 2.0F * (1.0F - kr) * chromaScale;
  const float blueFromU = 2.0F * (1.0F - kb) * chromaScale;
  YuvConversion result{};
  result.toRgb = glm::mat3(  // columns: Y, U, V
      glm::vec3(lumaScale), glm::vec3(0.0F, -blueFromU * kb / kg, blueFromU),
      glm::vec3(redFromV, -redFromV * kr / kg, 0.0F));
  result.offset = glm::vec3(limited ? 16.0F / 255.0F : 0.0F, 128.0F / 255.0F, 128.0F / 255.0F);
  return result;
}

/// Where chroma samples sit, as a shift in chroma texels after halving the pixel coordinate.
glm::vec2 chromaShift(hal::ColorRange range) {
  return range == hal::ColorRange::kLimited ? glm::vec2(0.25F, 0.0F) : glm::vec2(0.0F);
}

/// Column and row (0 or 1) of the red site.
glm::ivec2 redSite(PixelFormat format) {
  switch (format) {
    case PixelFormat::kBayerGrbg8:
      return {1, 0};
    case PixelFormat::kBayerGbrg8:
      return {0, 1};
    case PixelFormat::kBayerBggr8:
      return {1, 1};
    default:
      return {0, 0};
  }
}

}  // namespace

FrameUploader::FrameUploader(const ShaderLibrary& library)
    : convert_(library.fragmentPass("pipeline/gpu/shaders/camera_picture.frag")),
      resample_(library.fragmentPass("pipeline/gpu/shaders/resample.frag")) {}

const Texture& FrameUploader::upload(const hal::ImageView& image, FrameSize size) {
  assert(image.isComplete());
  uploadPlanes(image);
  convert(image.format);
  if (size == image.format.size) return native_;
  if (scaled_.size() != size) {
    scaled_ = Texture(TextureFormat::kRgba8, size, TextureFilter::kLinear);
    scaledTarget_ = RenderTarget({&scaled_});
  }
  const CoverFit fit = coverFit(image.format.size, size);
  resample_.use()
      .texture("picture", native_)
      .set("sourceOrigin", glm::vec2(fit.origin))
      .set("sourceScale", glm::vec2(fit.scale))
      .drawFullscreen(scaledTarget_);
  return scaled_;
}

void FrameUploader::uploadPlanes(const hal::ImageView& image) {
  const int count = planeCount(image.format.pixelFormat);
  const bool changed = !native_ || planesFormat_.size != image.format.size ||
                       planesFormat_.pixelFormat != image.format.pixelFormat;
  for (int plane = 0; plane < count; ++plane) {
    const auto i = static_cast<std::size_t>(plane);
    if (changed) {
      const PlaneTexture wanted = planeTexture(image.format, plane);
      const bool chroma = plane > 0;
      planes_[i] = Texture(wanted.format, wanted.size,
                           chroma ? TextureFilter::kLinear : TextureFilter::kNearest);
    }
    planes_[i].upload(image.planes[i].bytes, image.planes[i].strideBytes);
  }
  if (!native_ || native_.size() != image.format.size) {
    native_ = Texture(TextureFormat::kRgba8, image.format.size, TextureFilter::kLinear);
    nativeTarget_ = RenderTarget({&native_});
  }
  planesFormat_ = image.format;
}

void FrameUploader::convert(const hal::FrameFormat& format) {
  const YuvConversion yuv = yuvConversion(format.encoding);
  const bool has3 = format.pixelFormat == PixelFormat::kI420;
  const bool has2 = has3 || format.pixelFormat == PixelFormat::kNv12;
  convert_.use()
      .texture("plane0", planes_[0])
      .texture("plane1", has2 ? planes_[1] : planes_[0])
      .texture("plane2", has3 ? planes_[2] : planes_[0])
      .set("layoutKind", static_cast<int>(layoutOf(format.pixelFormat)))
      .set("yuvToRgb", yuv.toRgb)
      .set("yuvOffset", yuv.offset)
      .set("chromaShift", chromaShift(format.encoding.range))
      .set("bayerOrigin", redSite(format.pixelFormat))
      .set("pictureSize", glm::ivec2(format.size.width, format.size.height))
      .drawFullscreen(nativeTarget_);
}

}  // namespace pleinair::gpu
