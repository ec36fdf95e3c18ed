#include "pipeline/tracking/image/luma.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <optional>

#include <opencv2/imgproc.hpp>

#include "pipeline/tracking/image/luma_pyramid.h"

namespace pleinair::tracking {
namespace {

using hal::PixelFormat;

/// A cv::Mat header over borrowed pixels, which OpenCV only reads.
cv::Mat matOver(const hal::ImageView& image, int type) {
  const hal::PlaneView& plane = image.planes[0];
  auto* const bytes = const_cast<std::uint8_t*>(plane.bytes.data());
  return {image.format.size.height, image.format.size.width, type, bytes, plane.strideBytes};
}

/// OpenCV names a mosaic by the second and third pixel of its second row: OpenCV's BG is our RGGB.
int bayerConversion(PixelFormat format) {
  switch (format) {
    case PixelFormat::kBayerRggb8:
      return cv::COLOR_BayerBG2GRAY;
    case PixelFormat::kBayerGrbg8:
      return cv::COLOR_BayerGB2GRAY;
    case PixelFormat::kBayerGbrg8:
      return cv::COLOR_BayerGR2GRAY;
    default:
      return cv::COLOR_BayerRG2GRAY;
  }
}

}  // namespace

hal::PlaneView LumaConverter::convert(const hal::ImageView& image) {
  assert(image.isComplete());
  if (const std::optional<hal::PlaneView> own = hal::lumaPlane(image)) return *own;

  const hal::FrameSize size = image.format.size;
  buffer_.resize(static_cast<std::size_t>(size.pixels()));
  cv::Mat luma(size.height, size.width, CV_8UC1, buffer_.data());
  switch (image.format.pixelFormat) {
    case PixelFormat::kRgb8:
      cv::cvtColor(matOver(image, CV_8UC3), luma, cv::COLOR_RGB2GRAY);
      break;
    case PixelFormat::kRgba8:
      cv::cvtColor(matOver(image, CV_8UC4), luma, cv::COLOR_RGBA2GRAY);
      break;
    case PixelFormat::kYuyv:
      cv::extractChannel(matOver(image, CV_8UC2), luma, 0);
      break;
    default:
      cv::cvtColor(matOver(image, CV_8UC1), luma, bayerConversion(image.format.pixelFormat));
      break;
  }
  assert(luma.data == buffer_.data());
  return {.bytes = buffer_, .strideBytes = static_cast<std::size_t>(size.width)};
}

hal::PlaneView LumaConverter::copy(const hal::ImageView& image) {
  const hal::PlaneView luma = convert(image);
  if (luma.bytes.data() == buffer_.data()) return luma;
  const auto width = static_cast<std::size_t>(image.format.size.width);
  const auto height = static_cast<std::size_t>(image.format.size.height);
  buffer_.resize(width * height);
  for (std::size_t y = 0; y < height; ++y) {
    std::ranges::copy(luma.bytes.subspan(y * luma.strideBytes, width),
                      buffer_.begin() + static_cast<std::ptrdiff_t>(y * width));
  }
  return {.bytes = buffer_, .strideBytes = width};
}

void LumaFrame::takeCopy(const hal::ImageView& image) {
  take(converter_.copy(image), image.format.size);
}

void LumaFrame::take(const hal::ImageView& image) {
  image_ = image;
  size_ = image.format.size;
  lumaSize_ = size_;
  luma_.reset();
  pyramid_.reset();
}

void LumaFrame::takeReduced(const hal::PlaneView& luma, hal::FrameSize lumaSize,
                            hal::FrameSize frameSize) {
  luma_ = luma;
  size_ = frameSize;
  lumaSize_ = lumaSize;
  pyramid_.reset();
}

const hal::PlaneView& LumaFrame::luma() {
  assert(lumaSize_ == size_ && "the frame was taken reduced");
  if (!luma_) luma_ = converter_.convert(image_);
  return *luma_;
}

std::shared_ptr<const LumaPyramid> LumaFrame::pyramid() {
  if (pyramid_) return pyramid_;
  // All that key frames, the previous frame and this one may share, so that none is made later.
  constexpr std::size_t kUsual = 7;
  while (pyramids_.size() < kUsual) pyramids_.push_back(std::make_shared<LumaPyramid>());
  const auto free =
      std::ranges::find_if(pyramids_, [](const auto& each) { return each.use_count() == 1; });
  const auto made =
      free != pyramids_.end() ? *free : pyramids_.emplace_back(std::make_shared<LumaPyramid>());
  made->load(luma_ ? *luma_ : luma(), lumaSize_, size_, kLongSidePx);
  pyramid_ = made;
  return pyramid_;
}

}  // namespace pleinair::tracking
