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
/// The colours of R, G and B.
enum class ColorPrimaries { kUnknown, kBt709, kSmpte170m, kBt470bg, kBt2020, kOther };
/// How light is coded as R', G' and B'.
enum class ColorTransfer { kUnknown, kBt709, kSrgb, kLinear, kPq, kOther };

/// What a source says of its colours. Pictures are shown by matrix and range; primaries and
/// transfer are kept as told, and taken for sRGB's.
struct ColorEncoding {
  ColorMatrix matrix = ColorMatrix::kBt601;
  ColorRange range = ColorRange::kLimited;
  ColorPrimaries primaries = ColorPrimaries::kUnknown;
  ColorTransfer transfer = ColorTransfer::kUnknown;
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
std::string_view toString(ColorPrimaries primaries);
std::string_view toString(ColorTransfer transfer);

/// A pixel layout as DRM names it (drm_fourcc.h).
constexpr std::uint32_t drmFourcc(char a, char b, char c, char d) {
  const auto byte = [](char character) {
    return std::uint32_t{static_cast<unsigned char>(character)};
  };
  return byte(a) | byte(b) << 8 | byte(c) << 16 | byte(d) << 24;
}
/// DRM's name of the layout of all planes; for mosaics, which it has no name for, that of bytes
/// without a meaning (R8).
std::uint32_t drmFourccOf(PixelFormat format);
/// The modifier of rows one after the other.
inline constexpr std::uint64_t kLinearModifier = 0;

}  // namespace pleinair::hal
