#include "pipeline/measure/input/dense_motion.h"

#include <cstdint>
#include <utility>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace pleinair::measure {
namespace {

constexpr double kAgreePixels = 1.0;
/// Between neighbouring pixels: the field is smooth within a thing.
constexpr float kDenseBoundaryPixels = 0.5F;

cv::Mat1b lumaOf(const cv::Mat3b& picture) {
  cv::Mat1b luma;
  cv::cvtColor(picture, luma, cv::COLOR_RGB2GRAY);
  return luma;
}

struct DenseField {
  cv::Mat2f displacement;
  cv::Mat1b seen;  ///< 255 where both directions agree
};

DenseField denseField(const cv::Mat3b& earlier, const cv::Mat3b& later) {
  const cv::Ptr<cv::DISOpticalFlow> search =
      cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_MEDIUM);
  const cv::Mat1b from = lumaOf(earlier);
  const cv::Mat1b to = lumaOf(later);
  cv::Mat2f forward;
  cv::Mat2f backward;
  search->calc(from, to, forward);
  search->calc(to, from, backward);
  cv::Mat1b seen(forward.size(), 0);
  const cv::Rect frame({}, forward.size());
  for (int y = 0; y < forward.rows; ++y) {
    for (int x = 0; x < forward.cols; ++x) {
      const cv::Vec2f& by = forward(y, x);
      const cv::Point at = cv::Point(x, y) + cv::Point(cvRound(by[0]), cvRound(by[1]));
      if (frame.contains(at) && cv::norm(by + backward(at)) <= kAgreePixels) seen(y, x) = 255;
    }
  }
  return {.displacement = std::move(forward), .seen = std::move(seen)};
}

}  // namespace

MotionMap denseMotion(const cv::Mat3b& earlier, const cv::Mat3b& later) {
  DenseField field = denseField(earlier, later);
  return fieldMap(std::move(field.displacement), field.seen, kDenseBoundaryPixels);
}

MotionMap standingMotion(const cv::Mat3b& earlier, const cv::Mat3b& later,
                         const cv::Mat1b& earlierMovers, const cv::Mat1b& laterMovers) {
  DenseField field = denseField(earlier, later);
  const cv::Rect frame({}, field.seen.size());
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      cv::Vec2f& by = field.displacement(y, x);
      std::uint8_t& seen = field.seen(y, x);
      if (earlierMovers(y, x) == 0) {
        by = {};
        seen = laterMovers(y, x) == 0 ? 255 : 0;
        continue;
      }
      const cv::Point at = cv::Point(x, y) + cv::Point(cvRound(by[0]), cvRound(by[1]));
      if (!frame.contains(at) || laterMovers(at) == 0) seen = 0;
    }
  }
  return fieldMap(std::move(field.displacement), field.seen, kDenseBoundaryPixels);
}

}  // namespace pleinair::measure
