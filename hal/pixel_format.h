#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace pleinair::hal {

/// Memory layouts of images. The names are V4L2's and libav's where these two agree.
enum class PixelFormat {
  kGrey8,
  kRgb8,   ///< bytes R, G, B
  kRgba8,  ///< bytes R, G, B, A; alpha not premultiplied
  kYuyv,   ///< packed 4:2:2: Y0 U Y1 V
  kNv12,   ///< 4:2:0: plane Y, plane UV interleaved
  kI420,   ///< 4:2:0: planes Y, U, V
  kBayerRggb8,
  kBayerGrbg8,
  kBayerGbrg8,
  kBayerBggr8,
};

/// Y'CbCr to R'G'B' matrix.
enum class ColorMatrix { kBt601, kBt709 };
/// Whether luma spans 16..235 (limited) or 0..255 (full).
enum class ColorRange { kLimited, kFull };

struct ColorEncoding {
  ColorMatrix matrix = ColorMatrix::kBt601;
  ColorRange range = ColorRange::kLimited;
  friend bool operator==(const ColorEncoding&, const ColorEncoding&) = default;
};

/// Width and height in pixels.
struct FrameSize {
  int width = 0;
  int height = 0;
  std::int64_t pixels() const { return std::int64_t{width} * height; }
  friend bool operator==(const FrameSize&, const FrameSize&) = default;
};

/// The largest image that is accepted. A larger one is refused by its header, before decoding.
inline constexpr int kMaxSidePixels = 8192;
inline constexpr std::int64_t kMaxPixels = 64'000'000;
/// Whether both sides are at least 1 px and within the limits above.
bool isAcceptedSize(FrameSize size);

/// The layout of an image without its strides, which come with each plane.
struct FrameFormat {
  PixelFormat pixelFormat = PixelFormat::kRgb8;
  FrameSize size;
  ColorEncoding encoding;  ///< meaningful for Y'CbCr formats only
  friend bool operator==(const FrameFormat&, const FrameFormat&) = default;
};

int planeCount(PixelFormat format);
/// Bytes of one packed row of a plane. Odd sizes round chroma up.
std::size_t rowBytes(PixelFormat format, int plane, int width);
/// Rows of a plane.
int planeRows(PixelFormat format, int plane, int height);
bool isYCbCr(PixelFormat format);
bool isBayer(PixelFormat format);
std::string_view toString(PixelFormat format);

}  // namespace pleinair::hal
