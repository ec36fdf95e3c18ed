#include "pipeline/tracking/segments/cell_colours.h"

#include <array>
#include <cassert>
#include <cstddef>

#include <opencv2/imgproc.hpp>

namespace pleinair::tracking {
namespace {

using hal::PixelFormat;

CellColour fromRgb(float red, float green, float blue) {
  const float luma = 0.299F * red + 0.587F * green + 0.114F * blue;
  return {luma, 0.564F * (blue - luma), 0.713F * (red - luma)};
}

/// To full range. The matrix of the format is not regarded: distances hardly change.
CellColour fromYcbcr(hal::ColorRange range, float luma, float cb, float cr) {
  constexpr float kChromaZero = 128.0F;
  if (range == hal::ColorRange::kFull) return {luma, cb - kChromaZero, cr - kChromaZero};
  constexpr float kBlack = 16.0F;
  constexpr float kLumaGain = 255.0F / 219.0F;
  constexpr float kChromaGain = 255.0F / 224.0F;
  return {kLumaGain * (luma - kBlack), kChromaGain * (cb - kChromaZero),
          kChromaGain * (cr - kChromaZero)};
}

/// Which of a mosaic's four places, row by row, is red, and which is blue.
std::array<std::size_t, 2> redAndBlueOf(PixelFormat format) {
  switch (format) {
    case PixelFormat::kBayerRggb8:
      return {0, 3};
    case PixelFormat::kBayerGrbg8:
      return {1, 2};
    case PixelFormat::kBayerGbrg8:
      return {2, 1};
    default:
      return {3, 0};
  }
}

}  // namespace

cv::Mat CellColours::reducedPlane(int plane, const hal::ImageView& image, int channels,
                                  cv::Size size, int firstRow, int rowStep) {
  const hal::PlaneView& view = image.planes.at(static_cast<std::size_t>(plane));
  auto* const bytes = const_cast<std::uint8_t*>(view.bytes.data()) +
                      static_cast<std::size_t>(firstRow) * view.strideBytes;
  const cv::Mat whole(size, CV_8UC(channels), bytes,
                      static_cast<std::size_t>(rowStep) * view.strideBytes);
  cv::Mat& reduced = reduced_.emplace_back();
  cv::resize(whole, reduced, {grid_.width, grid_.height}, 0, 0, cv::INTER_AREA);
  return reduced;
}

void CellColours::reduce(const hal::ImageView& image, hal::FrameSize grid) {
  assert(image.isComplete());
  const hal::FrameSize size = image.format.size;
  const hal::ColorRange range = image.format.encoding.range;
  const cv::Size all(size.width, size.height);
  const cv::Size half((size.width + 1) / 2, (size.height + 1) / 2);
  grid_ = grid;
  reduced_.clear();
  colours_.resize(static_cast<std::size_t>(grid.pixels()));
  const auto convert = [this](const auto& colourOf) {
    std::size_t i = 0;
    for (int y = 0; y < grid_.height; ++y) {
      for (int x = 0; x < grid_.width; ++x) colours_[i++] = colourOf(y, x);
    }
  };
  switch (image.format.pixelFormat) {
    case PixelFormat::kGrey8: {
      const cv::Mat grey = reducedPlane(0, image, 1, all);
      convert([&](int y, int x) { return CellColour{static_cast<float>(grey.at<uchar>(y, x))}; });
      return;
    }
    case PixelFormat::kRgb8:
    case PixelFormat::kRgba8: {
      const int channels = image.format.pixelFormat == PixelFormat::kRgb8 ? 3 : 4;
      const cv::Mat rgb = reducedPlane(0, image, channels, all);
      convert([&](int y, int x) {
        const uchar* p = rgb.ptr<uchar>(y) + std::ptrdiff_t{x} * channels;
        return fromRgb(p[0], p[1], p[2]);
      });
      return;
    }
    case PixelFormat::kYuyv: {
      const cv::Mat pairs = reducedPlane(0, image, 4, {half.width, size.height});
      convert([&](int y, int x) {
        const auto& p = pairs.at<cv::Vec4b>(y, x);
        return fromYcbcr(range, 0.5F * static_cast<float>(p[0] + p[2]), p[1], p[3]);
      });
      return;
    }
    case PixelFormat::kNv12: {
      const cv::Mat luma = reducedPlane(0, image, 1, all);
      const cv::Mat chroma = reducedPlane(1, image, 2, half);
      convert([&](int y, int x) {
        const auto& c = chroma.at<cv::Vec2b>(y, x);
        return fromYcbcr(range, luma.at<uchar>(y, x), c[0], c[1]);
      });
      return;
    }
    case PixelFormat::kI420: {
      const cv::Mat luma = reducedPlane(0, image, 1, all);
      const cv::Mat cb = reducedPlane(1, image, 1, half);
      const cv::Mat cr = reducedPlane(2, image, 1, half);
      convert([&](int y, int x) {
        return fromYcbcr(range, luma.at<uchar>(y, x), cb.at<uchar>(y, x), cr.at<uchar>(y, x));
      });
      return;
    }
    default: {
      const cv::Size mosaic(size.width / 2, size.height / 2);
      const cv::Mat even = reducedPlane(0, image, 2, mosaic, 0, 2);
      const cv::Mat odd = reducedPlane(0, image, 2, mosaic, 1, 2);
      const auto [red, blue] = redAndBlueOf(image.format.pixelFormat);
      convert([&, redAt = red, blueAt = blue](int y, int x) {
        const auto& upper = even.at<cv::Vec2b>(y, x);
        const auto& lower = odd.at<cv::Vec2b>(y, x);
        const std::array<float, 4> four{static_cast<float>(upper[0]), static_cast<float>(upper[1]),
                                        static_cast<float>(lower[0]), static_cast<float>(lower[1])};
        const float green =
            0.5F * (four[0] + four[1] + four[2] + four[3] - four.at(redAt) - four.at(blueAt));
        return fromRgb(four.at(redAt), green, four.at(blueAt));
      });
    }
  }
}

}  // namespace pleinair::tracking
