#include "pipeline/measure/output_measures.h"

#include <cassert>
#include <cmath>
#include <utility>

#include "pipeline/measure/image_measures.h"
#include "pipeline/measure/input/picture.h"

namespace pleinair::measure {
namespace {

/// SCR looks only where the image has moved by the size of a mark: static content may stay on the
/// screen.
constexpr float kMovedPixels = 8.0F;
/// Part of the frame; with less, the correlation is meaningless.
constexpr double kMinMovedShare = 0.1;

cv::Mat1b movedMask(const MotionMap* motion, cv::Size size) {
  cv::Mat1b mask(size, 0);
  const cv::Rect inner = innerRect(size);
  if (motion == nullptr || motion->shift) {
    const bool isMoved =
        motion == nullptr || cv::norm(*motion->shift) >= static_cast<double>(kMovedPixels);
    if (isMoved) mask(inner).setTo(255);
    return mask;
  }
  for (int y = inner.y; y < inner.br().y; ++y) {
    for (int x = inner.x; x < inner.br().x; ++x) {
      const cv::Vec2f& by = motion->displacement(y, x);
      if (motion->valid(y, x) != 0 && std::hypot(by[0], by[1]) >= kMovedPixels) mask(y, x) = 255;
    }
  }
  return mask;
}

template <class Value>
std::optional<double> times(const Value& value, double factor) {
  return value ? std::optional(*value * factor) : std::nullopt;
}

std::optional<double> root(const std::optional<double>& value) {
  return value ? std::optional(std::sqrt(*value)) : std::nullopt;
}

}  // namespace

void OutputMeasures::add(const cv::Mat3f& output, const cv::Mat3f& input,
                         const MotionFromPast& motion) {
  assert(recent_.empty() || recent_.back().picture.size() == output.size());
  Frame frame;
  recent_.push_back({.picture = output, .highPass = highPass(output)});
  greys_.push_back(greyOf(output));
  frame.deviation = deviation(output, input);
  frame.detail = meanSquare(recent_.back().highPass);
  difference_.release();
  if (motion.shortLag != nullptr && recent_.size() > kShortLag) {
    compareShortLag(frame, *motion.shortLag);
  }
  if (greys_.size() > kLongLag) compareLongLag(frame, motion.longLag);
  if (recent_.size() > kShortLag) recent_.pop_front();
  if (greys_.size() > kLongLag) greys_.pop_front();
  frames_.push_back(frame);
}

void OutputMeasures::compareShortLag(Frame& frame, const MotionMap& motion) {
  const Recent& earlier = recent_.front();
  const Recent& later = recent_.back();
  const Warped<cv::Mat3f> carried = warpedBack(later.picture, motion);
  frame.error = warpingError(earlier.picture, carried);
  frame.popped = poppedShare(earlier.picture, carried);
  difference_ = differenceAlong(earlier.picture, carried);
  frame.highPassError =
      warpingError(earlier.highPass, warpedBack(later.highPass, motion, {}, kHighPassReach));
  frame.misalignedError = warpingError(
      earlier.highPass,
      warpedBack(later.highPass, motion, {kMisalignedX, kMisalignedY}, kHighPassReach));
}

void OutputMeasures::compareLongLag(Frame& frame, const MotionMap* motion) {
  const cv::Mat1f& earlier = greys_.front();
  const cv::Mat1f& later = greys_.back();
  if (motion != nullptr) frame.lasting = lastingMarks(earlier, warpedBack(later, *motion));
  const cv::Mat1b moved = movedMask(motion, later.size());
  if (cv::countNonZero(moved) < kMinMovedShare * static_cast<double>(moved.total())) return;
  const auto common = screenCorrelation(relativeGradient(earlier), relativeGradient(later), moved);
  if (common) frame.screen = {*common, 1.0};
}

Measures OutputMeasures::valuesOf(const Frame& frame, const Frame& input) {
  Measures measures;
  measures.ew2 = times(frame.error.value(), 1000.0);
  measures.xEw2 = ratio(frame.error.value(), input.error.value());
  measures.nHw2 = ratio(frame.highPassError.value(), frame.misalignedError.value());
  measures.popPercent = times(frame.popped.value(), 100.0);
  measures.s10Percent = times(frame.lasting.value(), 100.0);
  measures.scr = frame.screen.value();
  measures.dep = times(root(frame.deviation.value()), 255.0);
  measures.det = root(ratio(frame.detail.value(), input.detail.value()));
  return measures;
}

OutputMeasures::Frame OutputMeasures::total() const {
  Frame all;
  for (const Frame& frame : frames_) {
    all.error += frame.error;
    all.highPassError += frame.highPassError;
    all.misalignedError += frame.misalignedError;
    all.popped += frame.popped;
    all.lasting += frame.lasting;
    all.screen += frame.screen;
    all.deviation += frame.deviation;
    all.detail += frame.detail;
  }
  return all;
}

cv::Mat3f OutputMeasures::lastDifference() const {
  return difference_;
}

}  // namespace pleinair::measure
