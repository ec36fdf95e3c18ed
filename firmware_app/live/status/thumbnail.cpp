#include "firmware_app/live/status/thumbnail.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "hal/media/picture_encoder.h"

namespace pleinair::app {
namespace {

using Rgb = std::array<float, 3>;

std::size_t asIndex(int value) {
  return static_cast<std::size_t>(value);
}

/// R'G'B' of 0 … 255 from Y'CbCr, by the frame's own matrix and range.
Rgb rgbOf(float luma, float blue, float red, const hal::ColorEncoding& encoding) {
  const bool isLimited = encoding.range == hal::ColorRange::kLimited;
  const bool isHd = encoding.matrix == hal::ColorMatrix::kBt709;
  const float y = isLimited ? (luma - 16.0F) * 255.0F / 219.0F : luma;
  const float scale = isLimited ? 255.0F / 224.0F : 1.0F;
  const float b = (blue - 128.0F) * scale;
  const float r = (red - 128.0F) * scale;
  const float kr = isHd ? 0.2126F : 0.299F;
  const float kb = isHd ? 0.0722F : 0.114F;
  const float kg = 1.0F - kr - kb;
  const float redDifference = 2.0F * (1.0F - kr) * r;
  const float blueDifference = 2.0F * (1.0F - kb) * b;
  return {y + redDifference, y - (kr * redDifference + kb * blueDifference) / kg,
          y + blueDifference};
}

/// The colour of one pixel.
Rgb colourAt(const hal::ImageView& frame, int x, int y) {
  const auto row = frame.row(0, y);
  const hal::ColorEncoding& encoding = frame.format.encoding;
  switch (frame.format.pixelFormat) {
    case hal::PixelFormat::kRgb8:
    case hal::PixelFormat::kRgba8: {
      const int bytes = frame.format.pixelFormat == hal::PixelFormat::kRgb8 ? 3 : 4;
      const std::size_t at = asIndex(bytes * x);
      return {static_cast<float>(row[at]), static_cast<float>(row[at + 1]),
              static_cast<float>(row[at + 2])};
    }
    case hal::PixelFormat::kYuyv: {
      const std::size_t pair = asIndex(x / 2 * 4);
      return rgbOf(row[asIndex(2 * x)], row[pair + 1], row[pair + 3], encoding);
    }
    case hal::PixelFormat::kNv12: {
      const auto chroma = frame.row(1, y / 2);
      const std::size_t at = asIndex(x / 2 * 2);
      return rgbOf(row[asIndex(x)], chroma[at], chroma[at + 1], encoding);
    }
    case hal::PixelFormat::kI420:
      return rgbOf(row[asIndex(x)], frame.row(1, y / 2)[asIndex(x / 2)],
                   frame.row(2, y / 2)[asIndex(x / 2)], encoding);
    default: {
      const auto grey = static_cast<float>(row[asIndex(x)]);
      return {grey, grey, grey};
    }
  }
}

/// The mean colour of the pixels that a pixel of the small picture stands for; of large pictures,
/// at most four by four of them.
Rgb meanOf(const hal::ImageView& frame, int left, int top, int right, int bottom) {
  constexpr int kSamples = 4;
  Rgb sum{};
  int count = 0;
  const int stepX = std::max(1, (right - left) / kSamples);
  const int stepY = std::max(1, (bottom - top) / kSamples);
  for (int y = top; y < bottom; y += stepY) {
    for (int x = left; x < right; x += stepX) {
      const Rgb colour = colourAt(frame, x, y);
      for (std::size_t c = 0; c < 3; ++c) sum[c] += colour[c];
      ++count;
    }
  }
  for (float& channel : sum) channel /= static_cast<float>(std::max(count, 1));
  return sum;
}

}  // namespace

hal::Result<std::string> thumbnailJpeg(const hal::Image& frame, int quarterTurns) {
  const hal::ImageView view = frame.view();
  if (hal::isBayer(view.format.pixelFormat)) {
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kUnsupported,
                                     .subject = "thumbnail",
                                     .problem = "cannot be made of a raw picture"});
  }
  const hal::FrameSize full = view.format.size;
  const double scale =
      std::min(1.0, static_cast<double>(kThumbnailSide) / std::max(full.width, full.height));
  const auto scaled = [scale](int side) {
    return std::max(1, static_cast<int>(std::lround(side * scale)));
  };
  const hal::FrameSize small{scaled(full.width), scaled(full.height)};
  const int turns = ((quarterTurns % 4) + 4) % 4;
  const hal::FrameSize upright = turns % 2 == 0 ? small : hal::FrameSize{small.height, small.width};
  hal::Image picture({.pixelFormat = hal::PixelFormat::kRgb8, .size = upright, .encoding = {}});
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      const Rgb colour = meanOf(
          view, x * full.width / small.width, y * full.height / small.height,
          std::max((x + 1) * full.width / small.width, x * full.width / small.width + 1),
          std::max((y + 1) * full.height / small.height, y * full.height / small.height + 1));
      // Turned back counter-clockwise.
      const std::array<std::array<int, 2>, 4> places{{{x, y},
                                                      {y, small.width - 1 - x},
                                                      {small.width - 1 - x, small.height - 1 - y},
                                                      {small.height - 1 - y, x}}};
      const auto [toX, toY] = places.at(asIndex(turns));
      const auto row = picture.row(0, toY);
      for (std::size_t c = 0; c < 3; ++c) {
        row[asIndex(3 * toX) + c] =
            static_cast<std::uint8_t>(std::clamp(std::lround(colour[c]), 0L, 255L));
      }
    }
  }
  constexpr double kQuality = 85;
  auto encoder = hal::openPictureEncoder(hal::PictureFileKind::kJpeg, picture.view().format,
                                         {.quality = kQuality});
  if (!encoder) return tl::unexpected(encoder.error());
  const auto bytes = (*encoder)->encode(picture.view());
  if (!bytes) return tl::unexpected(bytes.error());
  return std::string(bytes->begin(), bytes->end());
}

}  // namespace pleinair::app
