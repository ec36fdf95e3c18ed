#include "pipeline/measure/mover_measures.h"

#include <cmath>
#include <cstddef>

#include <opencv2/imgproc.hpp>

#include "pipeline/measure/input/dense_motion.h"
#include "pipeline/measure/input/picture.h"
#include "pipeline/measure/mean.h"
#include "pipeline/measure/mover_regions.h"
#include "pipeline/measure/output_measures.h"

namespace pleinair::measure {
namespace {

constexpr double kAveragingSeconds = 0.65;

/// Paints the average of the input over the time constant of strokes: a negative control.
class AveragingPainter {
 public:
  cv::Mat3b paint(hal::TimePoint time, const cv::Mat3b& input) {
    if (mean_.empty()) {
      input.convertTo(mean_, CV_32F);
    } else {
      const double step = hal::toSeconds(time - last_);
      cv::accumulateWeighted(input, mean_, 1.0 - std::exp(-step / kAveragingSeconds));
    }
    last_ = time;
    cv::Mat3b output;
    mean_.convertTo(output, CV_8U);
    return output;
  }

 private:
  cv::Mat3f mean_;
  hal::TimePoint last_;
};

/// All regions of one painting of the sequence.
class PaintingRegions {
 public:
  explicit PaintingRegions(cv::Size size)
      : still_(size), suddenChange_(size), ground_(size), uncovered_(size) {}

  void add(const MoverFrame& frame) {
    if (covered_.weight == 0) ground_.start(frame.output);
    covered_ += shareWithinBorder(frame.zones.mover);
    still_.add(frame);
    suddenChange_.add(frame);
    lost_.add(frame, ground_);
    uncovered_.add(frame, ground_);
    firstPlace_.add(frame);
  }

  MoverSummary summary() const {
    return {.coveredPercent = 100.0 * covered_.value().value_or(0),
            .stillPercent = still_.percent(),
            .follow = suddenChange_.follow(),
            .returnLevels = uncovered_.returnLevels(),
            .ghost = uncovered_.ghost(),
            .lostPercent = lost_.percent(),
            .remainsPercent = firstPlace_.percent()};
  }

 private:
  Mean covered_;
  StillRegion still_;
  SuddenChangeRegion suddenChange_;
  Ground ground_;
  LostRegion lost_;
  UncoveredRegion uncovered_;
  FirstPlaceRegion firstPlace_;
};

cv::Mat3f inUnits(const cv::Mat3b& picture) {
  cv::Mat3f units;
  picture.convertTo(units, CV_32F, 1.0 / 255.0);
  return units;
}

MoverMotion alongDenseMotion(const std::vector<cv::Mat3b>& inputs,
                             const std::vector<cv::Mat3b>& outputs,
                             const std::vector<cv::Mat1b>& movers) {
  MoverMotion along(inputs.front().size());
  for (std::size_t t = 0; t < inputs.size(); ++t) {
    std::optional<MotionMap> motion;
    if (t >= kShortLag && cv::countNonZero(movers[t - kShortLag]) > 0) {
      motion = standingMotion(inputs[t - kShortLag], inputs[t], movers[t - kShortLag], movers[t]);
    }
    along.add(inUnits(inputs[t]), inUnits(outputs[t]), movers[t], motion ? &*motion : nullptr);
  }
  return along;
}

}  // namespace

void MoverMeasures::add(const MoverObservation& frame) {
  times_.push_back(frame.time);
  inputs_.emplace_back(toLevels(frame.input.view()));
  outputs_.emplace_back(toLevels(frame.output.view()));
  if (frame.trueMovers.empty()) return;
  trueMovers_.push_back(frame.trueMovers);
  if (!motion_) motion_.emplace(frame.trueMovers.size());
  motion_->add(toFloat(frame.input.view()), toFloat(frame.output.view()), frame.trueMovers,
               frame.trueMotion);
}

std::optional<MoverReport> MoverMeasures::total() const {
  if (inputs_.size() < 2) return std::nullopt;
  const cv::Size size = inputs_.front().size();
  const bool areTrue = !trueMovers_.empty();
  const std::vector<cv::Mat1b> movers = areTrue ? trueMovers_ : findMovers(inputs_);
  PaintingRegions painting(size);
  PaintingRegions averaging(size);
  StillRegion still(size);  // of the input
  StillRegion displacedStill(size);
  AveragingPainter average;
  for (std::size_t t = 0; t < inputs_.size(); ++t) {
    const cv::Mat3b& input = inputs_[t];
    const cv::Mat3b averaged = average.paint(times_[t], input);
    const MoverZones zones(movers[t]);
    const MoverZones displacedZones(displaced(movers[t]));
    painting.add({.time = times_[t], .input = input, .output = outputs_[t], .zones = zones});
    averaging.add({.time = times_[t], .input = input, .output = averaged, .zones = zones});
    still.add({.time = times_[t], .input = input, .output = input, .zones = zones});
    displacedStill.add(
        {.time = times_[t], .input = input, .output = input, .zones = displacedZones});
  }
  const MoverMotion motion = areTrue ? *motion_ : alongDenseMotion(inputs_, outputs_, movers);
  MoverReport report{.areMasksTrue = areTrue,
                     .painting = painting.summary(),
                     .alongMotion = {},
                     .averaging = averaging.summary(),
                     .displacedStillPercent = displacedStill.inputPercent()};
  // Noise alone changes pixels beside movers, too.
  if (report.displacedStillPercent) {
    *report.displacedStillPercent -= still.inputPercent().value_or(0);
  }
  for (const Subject subject : kAllSubjects) report.alongMotion[subject] = motion.of(subject);
  if (report.painting.coveredPercent == 0) report.displacedStillPercent.reset();
  return report;
}

}  // namespace pleinair::measure
