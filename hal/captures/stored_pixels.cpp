#include "hal/captures/stored_pixels.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/media/frame_pixels.h"

namespace pleinair::hal::captures {
namespace {

constexpr std::array kFormats{PixelFormat::kGrey8,      PixelFormat::kRgb8,
                              PixelFormat::kRgba8,      PixelFormat::kYuyv,
                              PixelFormat::kNv12,       PixelFormat::kI420,
                              PixelFormat::kBayerRggb8, PixelFormat::kBayerGrbg8,
                              PixelFormat::kBayerGbrg8, PixelFormat::kBayerBggr8};

std::uint8_t* rowOf(const AVFrame& frame, int plane, int y) {
  return frame.data[plane] + std::ptrdiff_t{y} * frame.linesize[plane];
}

/// Calls `move` with each byte of a packed pixel or macropixel and its place in the frame's planes:
/// the row of an image's plane, and where in the frame its bytes go.
template <class Byte, class Move>
void pair(PixelFormat format, int plane, int y, std::span<Byte> row, const AVFrame& frame,
          Move move) {
  switch (format) {
    case PixelFormat::kRgb8:  // B, G, R, 0
      for (std::size_t x = 0, to = 0; x + 2 < row.size(); x += 3, to += 4) {
        std::uint8_t* pixel = rowOf(frame, 0, y) + to;
        for (std::size_t i = 0; i < 3; ++i) move(row[x + i], pixel[2 - i]);
      }
      break;
    case PixelFormat::kRgba8:  // B, G, R, A
      for (std::size_t x = 0; x + 3 < row.size(); x += 4) {
        std::uint8_t* pixel = rowOf(frame, 0, y) + x;
        for (std::size_t i = 0; i < 3; ++i) move(row[x + i], pixel[2 - i]);
        move(row[x + 3], pixel[3]);
      }
      break;
    case PixelFormat::kYuyv:
      for (std::size_t i = 0; i + 3 < row.size(); i += 4) {
        move(row[i], rowOf(frame, 0, y)[i / 2]);
        move(row[i + 1], rowOf(frame, 1, y)[i / 4]);
        // Of an odd width, the last macropixel has a luma sample that no pixel shows.
        if (static_cast<int>(i / 2) + 1 < frame.width)
          move(row[i + 2], rowOf(frame, 0, y)[i / 2 + 1]);
        move(row[i + 3], rowOf(frame, 2, y)[i / 4]);
      }
      break;
    case PixelFormat::kNv12:
      if (plane == 1) {
        for (std::size_t i = 0; i + 1 < row.size(); i += 2) {
          move(row[i], rowOf(frame, 1, y)[i / 2]);
          move(row[i + 1], rowOf(frame, 2, y)[i / 2]);
        }
        break;
      }
      [[fallthrough]];
    default:
      for (std::size_t x = 0; x < row.size(); ++x) move(row[x], rowOf(frame, plane, y)[x]);
  }
}

}  // namespace

AVPixelFormat storedFormat(PixelFormat format) {
  switch (format) {
    case PixelFormat::kRgb8:
      return AV_PIX_FMT_0RGB32;
    case PixelFormat::kRgba8:
      return AV_PIX_FMT_RGB32;
    case PixelFormat::kYuyv:
      return AV_PIX_FMT_YUV422P;
    case PixelFormat::kNv12:
    case PixelFormat::kI420:
      return AV_PIX_FMT_YUV420P;
    default:
      return AV_PIX_FMT_GRAY8;
  }
}

void store(const ImageView& image, AVFrame& frame) {
  const PixelFormat format = image.format.pixelFormat;
  for (int plane = 0; plane < planeCount(format); ++plane) {
    for (int y = 0; y < planeRows(format, plane, image.format.size.height); ++y) {
      pair(format, plane, y, image.row(plane, y), frame,
           [](const std::uint8_t& from, std::uint8_t& to) { to = from; });
    }
  }
  if (!isYCbCr(format)) return;
  const bool isHd = image.format.encoding.matrix == ColorMatrix::kBt709;
  frame.colorspace = isHd ? AVCOL_SPC_BT709 : AVCOL_SPC_SMPTE170M;
  frame.color_range =
      image.format.encoding.range == ColorRange::kFull ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
}

std::optional<Image> restored(const AVFrame& frame, PixelFormat format) {
  const bool isStored =
      frame.format == storedFormat(format) ||
      (frame.format == AV_PIX_FMT_YUVJ420P && storedFormat(format) == AV_PIX_FMT_YUV420P) ||
      (frame.format == AV_PIX_FMT_YUVJ422P && storedFormat(format) == AV_PIX_FMT_YUV422P);
  if (!isStored) return std::nullopt;
  FrameFormat described{.pixelFormat = format, .size = {frame.width, frame.height}};
  if (isYCbCr(format)) {
    described.encoding = libav::encodingOf(frame).value_or(ColorEncoding{});
  }
  Image image(described);
  for (int plane = 0; plane < planeCount(format); ++plane) {
    for (int y = 0; y < planeRows(format, plane, frame.height); ++y) {
      pair(format, plane, y, image.row(plane, y), frame,
           [](std::uint8_t& to, const std::uint8_t& from) { to = from; });
    }
  }
  return image;
}

std::optional<PixelFormat> pixelFormatNamed(std::string_view name) {
  const auto* const found =
      std::ranges::find(kFormats, name, [](PixelFormat f) { return toString(f); });
  return found == kFormats.end() ? std::nullopt : std::optional(*found);
}

}  // namespace pleinair::hal::captures
