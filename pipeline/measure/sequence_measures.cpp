#include "pipeline/measure/sequence_measures.h"

#include <cmath>
#include <optional>
#include <utility>

#include "pipeline/measure/image_measures.h"

namespace pleinair::measure {

void StillMeasures::add(const cv::Mat3f& input, const cv::Mat3f& output) {
  PerSubject<cv::Mat3f> pictures = controls_.paint(input, output, frames_);
  for (const Subject subject : kAllSubjects) {
    if (frames_ > 0) flickers_[subject] += absoluteDifference(last_[subject], pictures[subject]);
  }
  last_ = std::move(pictures);
  ++frames_;
}

std::optional<double> StillMeasures::flicker(Subject subject) const {
  return ratio(flickers_[subject].value(), flickers_[Subject::kInput].value());
}

namespace {

/// Without a true motion, SCR counts only where the input itself moves on the screen.
constexpr double kStillScreen = 0.5;

}  // namespace

SequenceMeasures::SequenceMeasures(cv::Size frame, TrueMotion* motion)
    : motion_(motion), controls_(frame), anchors_(frame) {}

MotionKind SequenceMeasures::motionKind() const {
  return motion_ == nullptr ? MotionKind::kNone : motion_->kind();
}

hal::Result<std::optional<MotionMap>> SequenceMeasures::motionOver(std::uint64_t index,
                                                                   std::size_t lag) const {
  if (motion_ == nullptr || frames_ < lag) return std::nullopt;
  hal::Result<MotionMap> found = motion_->between(index - lag, index);
  if (!found) return tl::unexpected(found.error());
  return std::move(*found);
}

hal::Result<void> SequenceMeasures::add(std::uint64_t index, const cv::Mat3f& input,
                                        const cv::Mat3f& output,
                                        std::span<const marks::Anchor> anchors) {
  auto shortLag = motionOver(index, kShortLag);
  if (!shortLag) return tl::unexpected(shortLag.error());
  const auto longLag = motionOver(index, kLongLag);
  if (!longLag) return tl::unexpected(longLag.error());
  const MotionFromPast toHere{.shortLag = *shortLag ? &**shortLag : nullptr,
                              .longLag = *longLag ? &**longLag : nullptr};
  const PerSubject<cv::Mat3f> pictures = controls_.paint(input, output, index);
  for (const Subject subject : kAllSubjects) {
    outputs_[subject].add(pictures[subject], input, toHere);
  }
  if (!anchors.empty()) {
    const auto last = motionOver(index, 1);
    if (!last) return tl::unexpected(last.error());
    anchors_.add(anchors, *last ? &**last : nullptr, toHere.longLag);
  }
  if (motionKind() == MotionKind::kOther) {
    flatness_.add(input, output);
    if (toHere.shortLag != nullptr && frames_ % kShortLag == 0) flatness_.follow(*toHere.shortLag);
  }
  lastMotion_ = std::move(*shortLag);
  ++frames_;
  return {};
}

PerSubject<Measures> SequenceMeasures::totals() const {
  PerSubject<Measures> totals;
  const OutputMeasures::Frame input = outputs_[Subject::kInput].total();
  for (const Subject subject : kAllSubjects) {
    totals[subject] = OutputMeasures::valuesOf(outputs_[subject].total(), input);
  }
  const bool isStill = totals[Subject::kInput].scr.value_or(0) > kStillScreen;
  if (motion_ == nullptr && isStill) {
    for (const Subject subject : kAllSubjects) totals[subject].scr.reset();
  }
  return totals;
}

}  // namespace pleinair::measure
