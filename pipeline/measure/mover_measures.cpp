#include "pipeline/measure/mover_measures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "pipeline/measure/mean.h"
#include "pipeline/measure/mover_regions.h"

namespace pleinair::measure {
namespace {

constexpr double kAveragingSeconds = 0.65;

constexpr double kMaxStillPercent = 0.2;
constexpr double kMaxReturnLevels = 4.0;
constexpr double kMaxGhost = 0.25;
constexpr double kMaxLostPercent = 15.0;

cv::Mat3b copyOf(const hal::Image& image) {
  cv::Mat3b copy(image.size().height, image.size().width);
  const hal::ImageView view = image.view();
  for (int y = 0; y < copy.rows; ++y) {
    const auto row = view.row(0, y);
    std::copy_n(row.data(), static_cast<std::size_t>(copy.cols) * 3, copy.ptr<std::uint8_t>(y));
  }
  return copy;
}

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
  explicit PaintingRegions(cv::Size size) : ground_(size), uncovered_(size) {}

  void add(const MoverFrame& frame) {
    if (covered_.weight == 0) ground_.start(frame.output);
    covered_ += shareWithinBorder(frame.zones.mover);
    still_.add(frame);
    lost_.add(frame, ground_);
    uncovered_.add(frame, ground_);
  }

  MoverSummary summary() const {
    return {.coveredPercent = 100.0 * covered_.value().value_or(0),
            .stillPercent = still_.percent(),
            .returnLevels = uncovered_.returnLevels(),
            .ghost = uncovered_.ghost(),
            .lostPercent = lost_.percent()};
  }

 private:
  Mean covered_;
  StillRegion still_;
  Ground ground_;
  LostRegion lost_;
  UncoveredRegion uncovered_;
};

}  // namespace

void MoverMeasures::add(hal::TimePoint time, const hal::Image& input, const hal::Image& output) {
  times_.push_back(time);
  inputs_.push_back(copyOf(input));
  outputs_.push_back(copyOf(output));
}

std::optional<MoverReport> MoverMeasures::total() const {
  if (inputs_.size() < 2) return std::nullopt;
  const cv::Size size = inputs_.front().size();
  const std::vector<cv::Mat1b> movers = findMovers(inputs_);
  PaintingRegions painting(size);
  PaintingRegions averaging(size);
  StillRegion displaced;
  AveragingPainter average;
  for (std::size_t t = 0; t < inputs_.size(); ++t) {
    const cv::Mat3b& input = inputs_[t];
    const cv::Mat3b averaged = average.paint(times_[t], input);
    const MoverZones zones(movers[t]);
    const MoverZones wrong(laidWrong(movers[t]));
    painting.add({.time = times_[t], .input = input, .output = outputs_[t], .zones = zones});
    averaging.add({.time = times_[t], .input = input, .output = averaged, .zones = zones});
    displaced.add({.time = times_[t], .input = input, .output = input, .zones = wrong});
  }
  return MoverReport{.painting = painting.summary(),
                     .averaging = averaging.summary(),
                     .displacedStillPercent = displaced.inputPercent()};
}

namespace {

struct Limit {
  const char* name;
  const char* unit;
  double value;
  const char* missing;  ///< why there may be nothing to compare
  bool isUpper = true;
};

Verdict verdictOf(const Limit& limit, std::optional<double> value) {
  Verdict verdict{.what = fmt::format("{} {} {:g}{}", limit.name, limit.isUpper ? "≤" : ">",
                                      limit.value, limit.unit),
                  .found = limit.missing,
                  .comparison = Verdict::Comparison{
                      .value = value, .limit = limit.value, .isUpperLimit = limit.isUpper}};
  if (!value) return verdict;
  verdict.found = fmt::format("{:.3g}{}", *value, limit.unit);
  const bool isPassed = limit.isUpper ? *value <= limit.value : *value > limit.value;
  verdict.state = isPassed ? Verdict::State::kPassed : Verdict::State::kFailed;
  return verdict;
}

constexpr const char* kNothingUncovered = "no mover came and went";
constexpr const char* kNoClearMover = "no mover came that differs from the ground";
constexpr const char* kNothingStill = "movers are everywhere";

constexpr Limit kStillLimit{"STILL", " %", kMaxStillPercent, kNothingStill};
constexpr Limit kReturnLimit{"RETURN", "", kMaxReturnLevels, kNothingUncovered};
constexpr Limit kGhostLimit{"GHOST", "", kMaxGhost, kNothingUncovered};
constexpr Limit kLostLimit{"LOST", " %", kMaxLostPercent, kNoClearMover};
constexpr Limit kAveragingLost{"LOST of a painter that averages over 0.65 s", " %", kMaxLostPercent,
                               kNoClearMover, false};
constexpr Limit kDisplacedStill{"the input's pixels that change, under masks laid wrong by 20 px",
                                " %", kMaxStillPercent, kNothingStill, false};

}  // namespace

std::vector<Verdict> moverVerdicts(const MoverSummary& movers, bool isOnPaper) {
  std::vector<Verdict> verdicts{verdictOf(kStillLimit, movers.stillPercent),
                                verdictOf(kReturnLimit, movers.returnLevels),
                                verdictOf(kGhostLimit, movers.ghost)};
  if (!isOnPaper) verdicts.push_back(verdictOf(kLostLimit, movers.lostPercent));
  return verdicts;
}

std::vector<Verdict> moverControlVerdicts(const MoverReport& movers) {
  return {verdictOf(kAveragingLost, movers.averaging.lostPercent),
          verdictOf(kDisplacedStill, movers.displacedStillPercent)};
}

}  // namespace pleinair::measure
