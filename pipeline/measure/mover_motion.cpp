#include "pipeline/measure/mover_motion.h"

#include <utility>

#include <opencv2/imgproc.hpp>

#include "pipeline/measure/image_measures.h"
#include "pipeline/measure/input/picture.h"
#include "pipeline/measure/mover_masks.h"
#include "pipeline/measure/output_measures.h"

namespace pleinair::measure {
namespace {

constexpr int kSeamPixels = 8;
constexpr double kLineSmoothing = 2.0;  // px

cv::Mat1b seamOf(const cv::Mat1b& movers) {
  cv::Mat1b seam;
  cv::subtract(grown(movers, kSeamPixels), eroded(movers, kSeamPixels), seam);
  return seam;
}

cv::Mat3f smoothed(const cv::Mat3f& picture) {
  cv::Mat3f smooth;
  cv::GaussianBlur(picture, smooth, {}, kLineSmoothing);
  return smooth;
}

}  // namespace

void MoverMotion::add(const cv::Mat3f& input, const cv::Mat3f& output, const cv::Mat1b& movers,
                      const MotionMap* motion) {
  const bool hasMovers = cv::countNonZero(movers) > 0;
  const bool isCompared = motion != nullptr && recent_.size() >= kShortLag &&
                          recent_[recent_.size() - kShortLag].hasMovers;
  Recent now{.pictures = {}, .movers = movers, .hasMovers = hasMovers};
  if (hasMovers || isCompared) now.pictures = controls_.paint(input, output, frames_);
  recent_.push_back(std::move(now));
  if (recent_.size() > kShortLag + 1) recent_.pop_front();
  ++frames_;
  if (!isCompared) return;
  for (const Subject subject : kAllSubjects) {
    compare(subject, recent_.front(), recent_.back(), *motion);
  }
}

void MoverMotion::compare(Subject subject, const Recent& earlier, const Recent& later,
                          const MotionMap& motion) {
  const cv::Mat3f& from = earlier.pictures[subject];
  const cv::Mat3f& to = later.pictures[subject];
  Sums& sums = sums_[subject];
  const MotionMap onMovers = limitedTo(earlier.movers, motion);
  const MotionMap inSeam = limitedTo(seamOf(earlier.movers), motion);
  sums.popped += poppedShare(from, warpedBack(to, onMovers));
  sums.seamPopped += poppedShare(from, warpedBack(to, inSeam));
  const cv::Mat3f smooth = smoothed(from);
  const cv::Mat3f smoothLater = smoothed(to);
  sums.smoothPopped += poppedShare(smooth, warpedBack(smoothLater, onMovers));
  sums.smoothSeamPopped += poppedShare(smooth, warpedBack(smoothLater, inSeam));
  const MotionMap inside = limitedTo(earlier.movers, motion, kHighPassReach);
  const cv::Mat3f fine = highPass(from);
  const cv::Mat3f fineLater = highPass(to);
  sums.error += warpingError(fine, warpedBack(fineLater, inside));
  sums.misaligned +=
      warpingError(fine, warpedBack(fineLater, inside, {kMisalignedX, kMisalignedY}));
}

MoverMotionSummary MoverMotion::of(Subject subject) const {
  const Sums& sums = sums_[subject];
  return {.nHw2 = ratio(sums.error.value(), sums.misaligned.value()),
          .popPercent = percentOf(sums.popped),
          .seamPopPercent = percentOf(sums.seamPopped),
          .smoothPopPercent = percentOf(sums.smoothPopped),
          .smoothSeamPopPercent = percentOf(sums.smoothSeamPopped)};
}

}  // namespace pleinair::measure
