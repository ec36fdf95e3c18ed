#include "pipeline/tracking/image/luma_pyramid.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace pleinair::tracking {

void LumaPyramid::load(const hal::PlaneView& luma, hal::FrameSize lumaSize,
                       hal::FrameSize frameSize, int longSidePx) {
  auto* const bytes = const_cast<std::uint8_t*>(luma.bytes.data());  // OpenCV only reads them
  const cv::Mat full(lumaSize.height, lumaSize.width, CV_8UC1, bytes, luma.strideBytes);
  const double scale = static_cast<double>(std::max(lumaSize.width, lumaSize.height)) /
                       static_cast<double>(longSidePx);
  frameSize_ = frameSize;
  if (scale > 1.0) {
    const cv::Size small(std::max(1, static_cast<int>(std::lround(lumaSize.width / scale))),
                         std::max(1, static_cast<int>(std::lround(lumaSize.height / scale))));
    cv::resize(full, reduced_, small, 0.0, 0.0, cv::INTER_AREA);
  } else {
    reduced_ = full;
  }
  reduction_ = {static_cast<double>(frameSize.width) / reduced_.cols,
                static_cast<double>(frameSize.height) / reduced_.rows};
  cv::buildOpticalFlowPyramid(reduced_, levels_, {kWindowPx, kWindowPx}, kLevels, true,
                              cv::BORDER_REFLECT_101, cv::BORDER_CONSTANT, false);
  if (scale <= 1.0) reduced_.release();  // reduced_ would refer to the caller's pixels
}

bool LumaPyramid::isInside(const cv::Point2f& own, double border) const {
  const cv::Size size = picture().size();
  return own.x > border && own.y > border && own.x < size.width - border &&
         own.y < size.height - border;
}

}  // namespace pleinair::tracking
