#include "pipeline/scene/light/linear_image.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <glm/common.hpp>

#include "pipeline/gpu/frames/ycbcr.h"

namespace pleinair::scene {
namespace {

using hal::PixelFormat;

std::array<float, 256> linearLevels() {
  std::array<float, 256> levels{};
  for (std::size_t i = 0; i < levels.size(); ++i) {
    levels[i] = linearFromSrgb(static_cast<float>(i) / 255.0F);
  }
  return levels;
}

const std::array<float, 256> kLinear = linearLevels();

/// Position of a mosaic's red pixel in its 2 × 2 cell.
glm::ivec2 redOf(PixelFormat format) {
  switch (format) {
    case PixelFormat::kBayerRggb8:
      return {0, 0};
    case PixelFormat::kBayerGrbg8:
      return {1, 0};
    case PixelFormat::kBayerGbrg8:
      return {0, 1};
    default:
      return {1, 1};
  }
}

}  // namespace

LinearImage::LinearImage(const hal::ImageView& image) : image_(image) {
  assert(image.isComplete());
  if (!hal::isYCbCr(image.format.pixelFormat)) return;
  const gpu::YcbcrConversion conversion = gpu::ycbcrConversion(image.format.encoding);
  rgbFromYcbcr_ = conversion.toRgb;
  ycbcrOffset_ = conversion.offset;
}

const std::uint8_t& LinearImage::byte(int plane, int x, int y) const {
  const hal::PlaneView& view = image_.planes[static_cast<std::size_t>(plane)];
  return view.bytes[static_cast<std::size_t>(y) * view.strideBytes + static_cast<std::size_t>(x)];
}

glm::vec3 LinearImage::fromYcbcr(int luma, int cb, int cr) const {
  const glm::vec3 coded = rgbFromYcbcr_ * (glm::vec3(luma, cb, cr) / 255.0F - ycbcrOffset_);
  glm::vec3 linear;
  for (int c = 0; c < 3; ++c) {
    const float level = 255.0F * std::clamp(coded[c], 0.0F, 1.0F) + 0.5F;
    linear[c] = kLinear[static_cast<std::size_t>(level)];
  }
  return linear;
}

glm::vec3 LinearImage::mosaicAt(int x, int y) const {
  const hal::FrameSize size = image_.format.size;
  if (size.width < 2 || size.height < 2) return glm::vec3(kLinear[byte(0, x, y)]);
  const int left = std::min(x & ~1, (size.width - 2) & ~1);
  const int top = std::min(y & ~1, (size.height - 2) & ~1);
  const glm::ivec2 red = redOf(image_.format.pixelFormat);
  const auto level = [&](int dx, int dy) { return kLinear[byte(0, left + dx, top + dy)]; };
  const float green = 0.5F * (level(1 - red.x, red.y) + level(red.x, 1 - red.y));
  return {level(red.x, red.y), green, level(1 - red.x, 1 - red.y)};
}

glm::vec3 LinearImage::at(int x, int y) const {
  switch (image_.format.pixelFormat) {
    case PixelFormat::kGrey8:
      return glm::vec3(kLinear[byte(0, x, y)]);
    case PixelFormat::kRgb8:
    case PixelFormat::kRgba8: {
      const int bytes = image_.format.pixelFormat == PixelFormat::kRgb8 ? 3 : 4;
      const std::uint8_t* pixel = &byte(0, bytes * x, y);
      return {kLinear[pixel[0]], kLinear[pixel[1]], kLinear[pixel[2]]};
    }
    case PixelFormat::kYuyv: {
      const int pair = 4 * (x / 2);
      return fromYcbcr(byte(0, 2 * x, y), byte(0, pair + 1, y), byte(0, pair + 3, y));
    }
    case PixelFormat::kNv12: {
      const int pair = 2 * (x / 2);
      return fromYcbcr(byte(0, x, y), byte(1, pair, y / 2), byte(1, pair + 1, y / 2));
    }
    case PixelFormat::kI420:
      return fromYcbcr(byte(0, x, y), byte(1, x / 2, y / 2), byte(2, x / 2, y / 2));
    default:
      return mosaicAt(x, y);
  }
}

ImageStatistics imageStatistics(const LinearImage& picture) {
  constexpr int kColumns = 40, kRows = 30;
  constexpr double kCount = double{kColumns} * kRows;
  const hal::FrameSize size = picture.size();
  ImageStatistics statistics;
  glm::dvec2 slope(0.0), squares(0.0);
  double sum = 0.0, sumOfSquares = 0.0;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const glm::vec3 light = picture.at((2 * column + 1) * size.width / (2 * kColumns),
                                         (2 * row + 1) * size.height / (2 * kRows));
      statistics.mean += glm::dvec3(light);
      const double doublings = std::log2(double{luminanceOf(light)} + 0.01);
      const glm::dvec2 at((2.0 * column + 1.0) / kColumns - 1.0, (2.0 * row + 1.0) / kRows - 1.0);
      slope += doublings * at;
      squares += at * at;
      sum += doublings;
      sumOfSquares += doublings * doublings;
    }
  }
  statistics.mean = glm::max(statistics.mean / kCount, glm::dvec3(1e-4));
  statistics.slope = slope / squares;
  const double variance = sumOfSquares - sum * sum / kCount;
  const glm::dvec2 ofSlope = statistics.slope * statistics.slope * squares;
  statistics.explained = (ofSlope.x + ofSlope.y) / std::max(variance, 1e-9);
  return statistics;
}

}  // namespace pleinair::scene
