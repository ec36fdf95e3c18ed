#include "pipeline/measure/sequence_measures.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "pipeline/measure/image_measures.h"

namespace pleinair::measure {

void StillMeasures::add(const cv::Mat3f& input, const cv::Mat3f& output, const cv::Mat1b* ignored) {
  PerSubject<cv::Mat3f> pictures = controls_.paint(input, output, frames_);
  if (frames_ > 0) {
    cv::Mat1b without = lastIgnored_.empty() ? cv::Mat1b(input.size(), 0) : lastIgnored_;
    if (ignored != nullptr) cv::bitwise_or(without, *ignored, without);
    for (const Subject subject : kAllSubjects) {
      cv::Mat3f now = pictures[subject].clone();
      last_[subject].copyTo(now, without);
      flickers_[subject] += absoluteDifference(last_[subject], now);
    }
  }
  last_ = std::move(pictures);
  lastIgnored_ = ignored == nullptr ? cv::Mat1b() : ignored->clone();
  ++frames_;
}

std::optional<double> StillMeasures::flicker(Subject subject) const {
  return ratio(flickers_[subject].value(), flickers_[Subject::kInput].value());
}

namespace {

/// Without a true motion, SCR counts only where the input itself moves on the screen.
constexpr double kStillScreen = 0.5;

}  // namespace

SequenceMeasures::SequenceMeasures(cv::Size frame, TrueMotion* motion, ModelMotion* models)
    : motion_(motion),
      models_(models),
      controls_(frame),
      anchors_(frame),
      anchorsOnModels_(frame) {}

MotionKind SequenceMeasures::motionKind() const {
  return motion_ == nullptr ? MotionKind::kNone : motion_->kind();
}

hal::Result<std::optional<MotionMap>> SequenceMeasures::motionOver(TrueMotion* motion,
                                                                   std::uint64_t index,
                                                                   std::size_t lag) const {
  if (motion == nullptr || frames_ < lag) return std::nullopt;
  hal::Result<MotionMap> found = motion->between(index - lag, index);
  if (!found) return tl::unexpected(found.error());
  return std::move(*found);
}

hal::Result<void> SequenceMeasures::add(std::uint64_t index, const cv::Mat3f& input,
                                        const cv::Mat3f& output,
                                        std::span<const marks::Anchor> anchors) {
  auto shortLag = motionOver(motion_, index, kShortLag);
  if (!shortLag) return tl::unexpected(shortLag.error());
  const auto longLag = motionOver(motion_, index, kLongLag);
  if (!longLag) return tl::unexpected(longLag.error());
  const MotionFromPast toHere{.shortLag = *shortLag ? &**shortLag : nullptr,
                              .longLag = *longLag ? &**longLag : nullptr};
  compareDisplaced(input, toHere.shortLag);
  const PerSubject<cv::Mat3f> pictures = controls_.paint(input, output, index);
  for (const Subject subject : kAllSubjects) {
    outputs_[subject].add(pictures[subject], input, toHere);
  }
  if (models_ != nullptr) {
    if (auto added = addModels(index, pictures, toHere); !added) return added;
    if (!anchors.empty()) addAnchorsOnModels(index, anchors);
  }
  if (!anchors.empty()) {
    const auto last = motionOver(motion_, index, 1);
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

void SequenceMeasures::compareDisplaced(const cv::Mat3f& input, const MotionMap* motion) {
  constexpr int kDisplacedPixels = 2;
  inputs_.push_back(input);
  if (motion != nullptr && inputs_.size() > kShortLag) {
    followed_ += warpingError(inputs_.front(), warpedBack(input, *motion));
    displaced_ += warpingError(inputs_.front(), warpedBack(input, *motion, {kDisplacedPixels, 0}));
  }
  if (inputs_.size() > kShortLag) inputs_.pop_front();
}

std::optional<double> SequenceMeasures::displacedXEw2() const {
  constexpr double kRounding = 1e-9;  // without noise and interpolation, the input has no error
  if (!followed_.value() || !displaced_.value()) return std::nullopt;
  return *displaced_.value() / std::max(*followed_.value(), kRounding);
}

/// The motion of models is known even where the camera's is not.
hal::Result<void> SequenceMeasures::addModels(std::uint64_t index,
                                              const PerSubject<cv::Mat3f>& pictures,
                                              const MotionFromPast& toHere) {
  const bool isKnown = motion_ == models_;
  auto shortLag = motionOver(isKnown ? nullptr : models_, index, kShortLag);
  if (!shortLag) return tl::unexpected(shortLag.error());
  auto longLag = motionOver(isKnown ? nullptr : models_, index, kLongLag);
  if (!longLag) return tl::unexpected(longLag.error());
  ModelMotionFromPast fromPast{.shortLag = isKnown     ? toHere.shortLag
                                           : *shortLag ? &**shortLag
                                                       : nullptr,
                               .longLag = isKnown    ? toHere.longLag
                                          : *longLag ? &**longLag
                                                     : nullptr};
  std::optional<MotionMap> forgetting;
  if (frames_ >= kShortLag) {
    auto found = models_->forgettingModels(index - kShortLag, index);
    if (!found) return tl::unexpected(found.error());
    forgetting = std::move(*found);
    fromPast.forgetting = &*forgetting;
  }
  const PaintedModels& shown = models_->models(index);
  regions_.add(pictures, shown.mask(), shown.changed, fromPast);
  return {};
}

void SequenceMeasures::addAnchorsOnModels(std::uint64_t index,
                                          std::span<const marks::Anchor> anchors) {
  std::optional<MotionMap> sinceLast, toLast, sinceLong;
  if (frames_ >= 1) {
    sinceLast = models_->ofModels(index - 1, index);
    toLast = models_->ofModels(index, index - 1);
  }
  if (frames_ >= kLongLag) sinceLong = models_->ofModels(index - kLongLag, index);
  anchorsOnModels_.add(anchors, {.sinceLast = sinceLast ? &*sinceLast : nullptr,
                                 .toLast = toLast ? &*toLast : nullptr,
                                 .sinceLong = sinceLong ? &*sinceLong : nullptr});
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
