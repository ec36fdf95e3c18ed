#include "pipeline/measure/label_measures.h"

#include <cassert>

#include <opencv2/imgproc.hpp>

#include "pipeline/marks/movers/motion_layers.h"
#include "pipeline/measure/mover_masks.h"

namespace pleinair::measure {
namespace {

constexpr int kCell = marks::MotionLayers::kCellPixels;
constexpr double kNoticeableShare = 0.003;  // of the frame
constexpr double kFoundShare = 0.5;         // of a mover
constexpr int kFarCells = kFarPixels / kCell;

/// The mask in cells: 255 where at least half of a cell is masked.
cv::Mat1b inCells(const cv::Mat1b& mask, cv::Size cells) {
  cv::Mat1b even;
  cv::copyMakeBorder(mask, even, 0, cells.height * kCell - mask.rows, 0,
                     cells.width * kCell - mask.cols, cv::BORDER_REPLICATE);
  cv::Mat1b mean;
  cv::resize(even, mean, cells, 0, 0, cv::INTER_AREA);
  cv::Mat1b cellMask;
  cv::threshold(mean, cellMask, 126, 255, cv::THRESH_BINARY);
  return cellMask;
}

double countOf(const cv::Mat1b& mask) {
  return cv::countNonZero(mask);
}

cv::Mat1b bothOf(const cv::Mat1b& a, const cv::Mat1b& b) {
  cv::Mat1b both;
  cv::bitwise_and(a, b, both);
  return both;
}

/// Intersection over union. Precondition: one of them is not empty.
double iouOf(const cv::Mat1b& a, const cv::Mat1b& b) {
  const double both = countOf(bothOf(a, b));
  return both / (countOf(a) + countOf(b) - both);
}

bool isNoticeable(const cv::Mat1b& truth) {
  return countOf(truth) >= kNoticeableShare * static_cast<double>(truth.total());
}

}  // namespace

void LabelMeasures::add(std::uint64_t frame, hal::TimePoint time, const cv::Mat1b& labels,
                        const cv::Mat1b& truth) {
  assert((truth.cols + kCell - 1) / kCell == labels.cols);
  const cv::Mat1b mover = inCells(truth, labels.size());
  summary_.hasMovers |= cv::countNonZero(mover) > 0;
  lastIou_.reset();
  if (isNoticeable(mover)) {
    overlap(frame, labels, mover);
    displacedIou_ += {iouOf(inCells(displaced(truth), labels.size()), mover), 1.0};
  }
  detect(frame, time, labels, mover);
  compareWithLast(labels, mover);
}

void LabelMeasures::overlap(std::uint64_t frame, const cv::Mat1b& labels, const cv::Mat1b& truth) {
  lastIou_ = iouOf(labels, truth);
  iou_ += {*lastIou_, 1.0};
  if (summary_.worstIou && *summary_.worstIou <= *lastIou_) return;
  summary_.worstIou = lastIou_;
  summary_.worstFrame = frame;
}

void LabelMeasures::detect(std::uint64_t frame, hal::TimePoint time, const cv::Mat1b& labels,
                           const cv::Mat1b& truth) {
  if (cv::countNonZero(truth) == 0) {
    presence_ = Presence::kNone;
    return;
  }
  if (presence_ == Presence::kNone && isNoticeable(truth)) {
    presence_ = Presence::kAwaited;
    cameAt_ = time;
    summary_.detections.push_back({.frame = frame});
  }
  if (presence_ != Presence::kAwaited) return;
  Detection& detection = summary_.detections.back();
  detection.frames = frame - detection.frame;
  detection.time = time - cameAt_;
  detection.isFound = countOf(bothOf(labels, truth)) >= kFoundShare * countOf(truth);
  if (detection.isFound) presence_ = Presence::kFound;
}

void LabelMeasures::compareWithLast(const cv::Mat1b& labels, const cv::Mat1b& truth) {
  const cv::Mat1b far = grown(truth, kFarCells);
  if (!lastLabels_.empty()) {
    cv::Mat1b away;
    cv::bitwise_or(far, lastFar_, away);
    cv::bitwise_not(away, away);
    cv::Mat1b changed;
    cv::bitwise_xor(labels, lastLabels_, changed);
    flips_ += {countOf(bothOf(changed, away)), countOf(away)};
  }
  lastLabels_ = labels;
  lastFar_ = far;
}

LabelSummary LabelMeasures::total() const {
  LabelSummary summary = summary_;
  summary.meanIou = iou_.value();
  summary.flipsPercent = percentOf(flips_);
  summary.displacedIou = displacedIou_.value();
  return summary;
}

}  // namespace pleinair::measure
