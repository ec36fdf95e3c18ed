#include "pipeline/measure/sequence_measures.h"

#include <cmath>
#include <optional>

namespace pleinair::measure {
namespace {

/// Without a true motion, SCR counts only where the input itself does not stay on the screen.
constexpr double kStillScreen = 0.5;

}  // namespace

SequenceMeasures::SequenceMeasures(cv::Size frame, TrueMotion* motion)
    : motion_(motion), controls_(frame) {}

MotionKind SequenceMeasures::motionKind() const {
  return motion_ == nullptr ? MotionKind::kNone : motion_->kind();
}

hal::Result<void> SequenceMeasures::add(std::uint64_t index, const cv::Mat3f& input,
                                        const cv::Mat3f& output) {
  std::optional<MotionMap> shortLag, longLag;
  for (auto [lag, map] : {std::pair(kShortLag, &shortLag), std::pair(kLongLag, &longLag)}) {
    if (motion_ == nullptr || frames_ < lag) continue;
    hal::Result<MotionMap> found = motion_->between(index - lag, index);
    if (!found) return tl::unexpected(found.error());
    *map = std::move(*found);
  }
  const MotionToHere toHere{.shortLag = shortLag ? &*shortLag : nullptr,
                            .longLag = longLag ? &*longLag : nullptr};
  const PerSubject<cv::Mat3f> pictures = controls_.paint(input, output, index);
  for (const Subject subject : kAllSubjects) {
    outputs_[subject].add(pictures[subject], input, toHere);
  }
  ++frames_;
  return {};
}

PerSubject<Measures> SequenceMeasures::totals() const {
  PerSubject<Measures> totals;
  const OutputMeasures& input = outputs_[Subject::kInput];
  const std::optional<double> inputError = input.error().value();
  const std::optional<double> inputDetail = input.detail().value();
  for (const Subject subject : kAllSubjects) {
    const OutputMeasures& output = outputs_[subject];
    totals[subject] = output.total();
    totals[subject].xEw2 = ratio(output.error().value(), inputError);
    const std::optional<double> detail = ratio(output.detail().value(), inputDetail);
    if (detail) totals[subject].det = std::sqrt(*detail);
  }
  const bool isStill = totals[Subject::kInput].scr.value_or(0) > kStillScreen;
  if (motion_ == nullptr && isStill) {
    for (const Subject subject : kAllSubjects) totals[subject].scr.reset();
  }
  return totals;
}

}  // namespace pleinair::measure
