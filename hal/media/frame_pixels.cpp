#include "hal/media/frame_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

#include "hal/media/errors.h"
#include "hal/media/icc_profile.h"
#include "hal/media/picture_decoder.h"
#include "hal/media/wide_colour.h"

namespace pleinair::hal::libav {
namespace {

std::size_t asSize(int value) {
  return static_cast<std::size_t>(value);
}

std::uint8_t* rowAt(const AVFrame& frame, int plane, int y) {
  return frame.data[plane] + std::ptrdiff_t{y} * frame.linesize[plane];
}

FrameSize storedSize(const AVFrame& frame) {
  return {frame.width, frame.height};
}

bool isJpegLayout(int format) {
  return format == AV_PIX_FMT_YUVJ420P || format == AV_PIX_FMT_YUVJ422P ||
         format == AV_PIX_FMT_YUVJ444P || format == AV_PIX_FMT_YUVJ440P ||
         format == AV_PIX_FMT_YUVJ411P;
}

/// Replaces the full-range layouts (YUVJ…), which swscale deprecates, by the same layouts without a
/// range.
AVPixelFormat plainLayout(int format) {
  switch (format) {
    case AV_PIX_FMT_YUVJ420P:
      return AV_PIX_FMT_YUV420P;
    case AV_PIX_FMT_YUVJ422P:
      return AV_PIX_FMT_YUV422P;
    case AV_PIX_FMT_YUVJ444P:
      return AV_PIX_FMT_YUV444P;
    case AV_PIX_FMT_YUVJ440P:
      return AV_PIX_FMT_YUV440P;
    case AV_PIX_FMT_YUVJ411P:
      return AV_PIX_FMT_YUV411P;
    default:
      return static_cast<AVPixelFormat>(format);
  }
}

bool isFullRange(const AVFrame& frame) {
  if (frame.color_range == AVCOL_RANGE_JPEG) return true;
  return frame.color_range == AVCOL_RANGE_UNSPECIFIED && isJpegLayout(frame.format);
}

std::optional<PixelFormat> nativeFormat(const AVFrame& frame) {
  switch (plainLayout(frame.format)) {
    case AV_PIX_FMT_YUV420P:
      return PixelFormat::kI420;
    case AV_PIX_FMT_NV12:
      return PixelFormat::kNv12;
    case AV_PIX_FMT_YUYV422:
      // In libav, rows of odd width end in half a macropixel.
      return frame.width % 2 == 0 ? std::optional(PixelFormat::kYuyv) : std::nullopt;
    case AV_PIX_FMT_GRAY8:
      return PixelFormat::kGrey8;
    case AV_PIX_FMT_RGB24:
      return PixelFormat::kRgb8;
    default:
      return std::nullopt;
  }
}

ImageView viewOf(const AVFrame& frame, FrameFormat format) {
  ImageView view{.format = format, .planes = {}};
  for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
    const std::size_t stride = asSize(frame.linesize[plane]);
    const std::size_t rows = asSize(planeRows(format.pixelFormat, plane, format.size.height));
    const std::size_t bytes =
        stride * (rows - 1) + rowBytes(format.pixelFormat, plane, format.size.width);
    view.planes[asSize(plane)] = {.bytes = {frame.data[plane], bytes}, .strideBytes = stride};
  }
  return view;
}

std::optional<LentPicture> lendWithoutCopy(const std::shared_ptr<const AVFrame>& frame) {
  const std::optional<PixelFormat> native = nativeFormat(*frame);
  if (!native) return std::nullopt;
  const std::optional<ColorEncoding> encoding =
      isYCbCr(*native) ? encodingOf(*frame) : ColorEncoding{};
  if (!encoding) return std::nullopt;
  for (int plane = 0; plane < planeCount(*native); ++plane) {
    if (frame->linesize[plane] <= 0) return std::nullopt;  // stored bottom-up
  }
  const FrameFormat format{
      .pixelFormat = *native, .size = {frame->width, frame->height}, .encoding = *encoding};
  return LentPicture{.view = viewOf(*frame, format), .lease = frame};
}

Frame allocate(AVPixelFormat format, int width, int height) {
  Frame frame = makeFrame();
  frame->format = format;
  frame->width = width;
  frame->height = height;
  if (av_frame_get_buffer(frame.get(), 0) < 0) throw std::bad_alloc();
  return frame;
}

Frame grey8FromGrey16(const AVFrame& source) {
  Frame target = allocate(AV_PIX_FMT_GRAY8, source.width, source.height);
  const bool bigEndian = source.format == AV_PIX_FMT_GRAY16BE;
  for (int y = 0; y < source.height; ++y) {
    const std::uint8_t* from = rowAt(source, 0, y);
    std::uint8_t* to = rowAt(*target, 0, y);
    for (int x = 0; x < source.width; ++x) {
      const std::uint32_t high = from[2 * x + (bigEndian ? 0 : 1)];
      const std::uint32_t low = from[2 * x + (bigEndian ? 1 : 0)];
      to[x] = static_cast<std::uint8_t>(((high << 8 | low) * 255 + 32767) / 65535);
    }
  }
  return target;
}

/// Sets the Y'CbCr matrix and range of both sides, so that swscale does not guess.
void setColors(SwsContext& scaler, const AVFrame& source) {
  int matrix = source.colorspace;
  if (const std::optional<ColorEncoding> encoding = encodingOf(source)) {
    matrix = encoding->matrix == ColorMatrix::kBt709 ? SWS_CS_ITU709 : SWS_CS_ITU601;
  }
  constexpr int kUnity = 1 << 16;
  sws_setColorspaceDetails(&scaler, sws_getCoefficients(matrix), isFullRange(source) ? 1 : 0,
                           sws_getCoefficients(SWS_CS_DEFAULT), 1, 0, kUnity, kUnity);
}

Result<Frame> convert(const AVFrame& source, AVPixelFormat format, FrameSize size) {
  constexpr int kFlags = SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_BITEXACT;
  const Scaler scaler(sws_getContext(source.width, source.height, plainLayout(source.format),
                                     size.width, size.height, format, kFlags, nullptr, nullptr,
                                     nullptr));
  if (scaler == nullptr) {
    const char* name = av_get_pix_fmt_name(static_cast<AVPixelFormat>(source.format));
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .problem = std::string("pixel format ") +
                                           (name != nullptr ? name : "unknown") +
                                           " cannot be converted",
                                .remedy = "convert the recording to 8-bit YUV 4:2:0"});
  }
  setColors(*scaler, source);
  Frame target = allocate(format, size.width, size.height);
  const int rows = sws_scale(scaler.get(), source.data, source.linesize, 0, source.height,
                             target->data, target->linesize);
  if (rows < 0) {
    return tl::unexpected(libavError("", "cannot convert to RGB", rows, ErrorKind::kUnsupported));
  }
  return target;
}

/// Composites over white in 8-bit sRGB, as image viewers do.
Frame overWhite(const AVFrame& rgba) {
  Frame target = allocate(AV_PIX_FMT_RGB24, rgba.width, rgba.height);
  for (int y = 0; y < rgba.height; ++y) {
    const std::uint8_t* from = rowAt(rgba, 0, y);
    std::uint8_t* to = rowAt(*target, 0, y);
    for (int x = 0; x < rgba.width; ++x, from += 4, to += 3) {
      const int alpha = from[3];
      for (int c = 0; c < 3; ++c) {
        to[c] = static_cast<std::uint8_t>((from[c] * alpha + 255 * (255 - alpha) + 127) / 255);
      }
    }
  }
  return target;
}

bool mayHaveAlpha(const AVFrame& frame) {
  const AVPixFmtDescriptor* layout = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
  return layout != nullptr && (layout->flags & (AV_PIX_FMT_FLAG_ALPHA | AV_PIX_FMT_FLAG_PAL)) != 0;
}

Result<Frame> convertToOurs(const AVFrame& source, FrameSize size) {
  const bool isGrey16 =
      source.format == AV_PIX_FMT_GRAY16BE || source.format == AV_PIX_FMT_GRAY16LE;
  if (isGrey16 && size == storedSize(source)) return grey8FromGrey16(source);
  if (!mayHaveAlpha(source)) return convert(source, AV_PIX_FMT_RGB24, size);
  Result<Frame> rgba = convert(source, AV_PIX_FMT_RGBA, size);
  if (!rgba) return rgba;
  return overWhite(**rgba);
}

LentPicture upright(const LentPicture& stored, Orientation orientation) {
  const auto image = std::make_shared<const Image>(oriented(stored.view, orientation));
  return {.view = image->view(), .lease = image};
}

Result<LentPicture> lendRgba(const AVFrame& frame) {
  Result<Frame> converted = convert(frame, AV_PIX_FMT_RGBA, storedSize(frame));
  if (!converted) return tl::unexpected(converted.error());
  const std::shared_ptr<const AVFrame> rgba = *std::move(converted);
  const FrameFormat format{.pixelFormat = PixelFormat::kRgba8, .size = {rgba->width, rgba->height}};
  return LentPicture{.view = viewOf(*rgba, format), .lease = rgba};
}

/// The frame in sRGB's colours, where its ICC profile says that it has others; else the frame
/// itself.
Result<std::shared_ptr<const AVFrame>> withoutProfile(const std::shared_ptr<const AVFrame>& frame) {
  const std::optional<IccConversion> conversion = IccConversion::of(*frame);
  if (!conversion) return frame;
  const Result<Frame> source = convert(*frame, conversion->sourceLayout(), storedSize(*frame));
  if (!source) return tl::unexpected(source.error());
  Frame target = allocate(conversion->targetLayout(), frame->width, frame->height);
  if (av_frame_copy_props(target.get(), frame.get()) < 0) throw std::bad_alloc();
  av_frame_remove_side_data(target.get(), AV_FRAME_DATA_ICC_PROFILE);
  target->color_primaries = AVCOL_PRI_BT709;
  target->color_trc = AVCOL_TRC_IEC61966_2_1;
  target->colorspace = AVCOL_SPC_RGB;
  target->color_range = AVCOL_RANGE_JPEG;
  conversion->apply(**source, *target);
  return std::shared_ptr<const AVFrame>(std::move(target));
}

/// Lends the image as stored, with square pixels, without applying its orientation.
Result<LentPicture> lendStored(const std::shared_ptr<const AVFrame>& frame, Delivery delivery,
                               Orientation orientation) {
  const FrameSize size = squarePixelSize(storedSize(*frame), frame->sample_aspect_ratio);
  if (isWideColour(*frame)) {
    Result<Frame> converted = toSrgb(*frame, size);
    if (!converted) return tl::unexpected(converted.error());
    return *lendWithoutCopy(*std::move(converted));
  }
  if (size != storedSize(*frame)) {
    Result<Frame> converted = convertToOurs(*frame, size);
    if (!converted) return tl::unexpected(converted.error());
    return *lendWithoutCopy(*std::move(converted));
  }
  std::optional<LentPicture> lent = lendWithoutCopy(frame);
  // YUYV cannot be rotated: pairs of its pixels share chroma.
  const bool mayStay =
      lent && delivery == Delivery::kAsStored &&
      (lent->view.format.pixelFormat != PixelFormat::kYuyv || orientation.isUpright());
  const bool serves = lent && (mayStay || lent->view.format.pixelFormat == PixelFormat::kRgb8);
  if (serves) return *std::move(lent);
  Result<Frame> converted = (lent || delivery == Delivery::kRgb) && !mayHaveAlpha(*frame)
                                ? convert(*frame, AV_PIX_FMT_RGB24, size)
                                : convertToOurs(*frame, size);
  if (!converted) return tl::unexpected(converted.error());
  return *lendWithoutCopy(*std::move(converted));
}

}  // namespace

Orientation orientationOf(const AVFrame& frame) {
  const AVFrameSideData* side = av_frame_get_side_data(&frame, AV_FRAME_DATA_DISPLAYMATRIX);
  std::array<std::int32_t, 9> matrix{};
  if (side == nullptr || side->size < sizeof(matrix)) return {};
  std::memcpy(matrix.data(), side->data, sizeof(matrix));
  return orientationOf(matrix);
}

std::optional<ColorEncoding> encodingOf(const AVFrame& frame) {
  constexpr int kFirstHdLine = 720;
  const ColorRange range = isFullRange(frame) ? ColorRange::kFull : ColorRange::kLimited;
  switch (frame.colorspace) {
    case AVCOL_SPC_BT709:
      return ColorEncoding{.matrix = ColorMatrix::kBt709, .range = range};
    case AVCOL_SPC_BT470BG:
    case AVCOL_SPC_SMPTE170M:
    case AVCOL_SPC_FCC:
      return ColorEncoding{.matrix = ColorMatrix::kBt601, .range = range};
    case AVCOL_SPC_UNSPECIFIED:
    case AVCOL_SPC_RESERVED:
      return ColorEncoding{.matrix = frame.height >= kFirstHdLine && !isJpegLayout(frame.format)
                                         ? ColorMatrix::kBt709
                                         : ColorMatrix::kBt601,
                           .range = range};
    default:
      return std::nullopt;
  }
}

FrameSize squarePixelSize(FrameSize stored, AVRational aspect) {
  constexpr double kMostAspect = 8.0;  // more is a broken header
  constexpr double kRounding = 0.005;
  if (aspect.num <= 0 || aspect.den <= 0) return stored;
  const double wide = av_q2d(aspect);
  if (wide > kMostAspect || wide < 1.0 / kMostAspect || std::abs(wide - 1.0) < kRounding) {
    return stored;
  }
  const auto scaled = [](int side, double by) {
    return std::max(1, static_cast<int>(std::lround(side * by)));
  };
  const FrameSize wider{scaled(stored.width, wide), stored.height};
  const FrameSize higher{stored.width, scaled(stored.height, 1.0 / wide)};
  const FrameSize enlarged = wide > 1.0 ? wider : higher;
  if (isAcceptedSize(enlarged)) return enlarged;
  return wide > 1.0 ? higher : wider;
}

Result<LentPicture> lendPicture(const std::shared_ptr<const AVFrame>& frame, Delivery delivery) {
  const FrameSize size{frame->width, frame->height};
  if (!isAcceptedSize(size)) {
    return tl::unexpected(tooLarge("", size));
  }
  if (delivery == Delivery::kRgba) return lendRgba(*frame);
  const Result<std::shared_ptr<const AVFrame>> plain = withoutProfile(frame);
  if (!plain) return tl::unexpected(plain.error());
  const Orientation orientation = orientationOf(*frame);
  Result<LentPicture> stored = lendStored(*plain, delivery, orientation);
  if (!stored || orientation.isUpright()) return stored;
  return upright(*stored, orientation);
}

}  // namespace pleinair::hal::libav
