#include "pipeline/gpu/frames/frame_upload.h"

#include <cassert>
#include <utility>

#include "pipeline/gpu/frames/frame_planes.h"
#include "pipeline/gpu/frames/ycbcr.h"

namespace pleinair::gpu {
namespace {

using hal::FrameSize;
using hal::PixelFormat;

/// Shaders of their own: the software rasteriser runs every branch of a shared one.
enum class Layout : std::size_t { kRgb, kGrey, kNv12, kI420, kYuyv, kBayer };

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

/// Where chroma samples sit, as a shift in chroma texels after halving the pixel coordinate.
glm::vec2 chromaShift(hal::ColorEncoding encoding) {
  return isChromaLeftSited(encoding) ? glm::vec2(0.25F, 0.0F) : glm::vec2(0.0F);
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
    : convert_{library.fragmentPass(
                   "pipeline/gpu/frames/shaders/camera_rgb.frag"),  // in Layout's order
               library.fragmentPass("pipeline/gpu/frames/shaders/camera_grey.frag"),
               library.fragmentPass("pipeline/gpu/frames/shaders/camera_nv12.frag"),
               library.fragmentPass("pipeline/gpu/frames/shaders/camera_i420.frag"),
               library.fragmentPass("pipeline/gpu/frames/shaders/camera_yuyv.frag"),
               library.fragmentPass("pipeline/gpu/frames/shaders/camera_bayer.frag")},
      convertBytes_(
          library.fragmentPass("pipeline/gpu/frames/shaders/camera_rgb.frag", {{"BYTES"}})),
      resampler_(library) {}

const Texture& FrameUploader::upload(const hal::ImageView& image, FrameSize size,
                                     const AspectFill& fit) {
  assert(image.isComplete());
  uploadPlanes(image);
  convert(image.format, planes_, false);
  return resampler_.resample(native_, size, fit);
}

const Texture& FrameUploader::show(const hal::FrameFormat& format, std::span<const Texture> planes,
                                   FrameSize size, const AspectFill& fit) {
  prepareNative(format.size);
  convert(format, planes, true);
  return resampler_.resample(native_, size, fit);
}

void FrameUploader::uploadPlanes(const hal::ImageView& image) {
  const int count = planeCount(image.format.pixelFormat);
  const bool changed = planesFormat_.size != image.format.size ||
                       planesFormat_.pixelFormat != image.format.pixelFormat;
  if (changed) planesFormat_ = {};  // stays so where there is no memory for the new planes
  for (int plane = 0; plane < count; ++plane) {
    const auto i = static_cast<std::size_t>(plane);
    if (changed) {
      const PlaneTexture wanted = uploadedPlane(image.format, plane);
      planes_[i] = Texture(wanted.format, wanted.size, wanted.filter);
    }
    planes_[i].upload(image.planes[i].bytes, image.planes[i].strideBytes);
    uploadedBytes_ += rowBytes(image.format.pixelFormat, plane, image.format.size.width) *
                      static_cast<std::size_t>(
                          planeRows(image.format.pixelFormat, plane, image.format.size.height));
  }
  prepareNative(image.format.size);
  planesFormat_ = image.format;
}

void FrameUploader::prepareNative(FrameSize size) {
  if (native_ && native_.size() == size) return;
  native_ = Texture();
  Texture native(TextureFormat::kRgba8, size, TextureFilter::kLinear);
  nativeTarget_ = RenderTarget({&native});
  native_ = std::move(native);
}

void FrameUploader::convert(const hal::FrameFormat& format, std::span<const Texture> planes,
                            bool areImported) {
  constexpr std::array kSamplers{"plane0", "plane1", "plane2"};
  const bool areBytes = areImported && format.pixelFormat == PixelFormat::kRgb8;
  Program& program =
      areBytes ? convertBytes_ : convert_[static_cast<std::size_t>(layoutOf(format.pixelFormat))];
  program.use();
  for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
    const auto i = static_cast<std::size_t>(plane);
    program.texture(kSamplers[i], planes[i]);
  }
  if (isYCbCr(format.pixelFormat)) {
    const YcbcrConversion ycbcr = ycbcrConversion(format.encoding);
    program.set("rgbFromYcbcr", ycbcr.toRgb)
        .set("ycbcrOffset", ycbcr.offset)
        .set("chromaShift", chromaShift(format.encoding));
  } else if (isBayer(format.pixelFormat)) {
    program.set("bayerOrigin", redSite(format.pixelFormat));
  }
  program.drawFullscreen(nativeTarget_);
}

}  // namespace pleinair::gpu
