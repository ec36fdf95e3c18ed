#include "pipeline/measure/mover_measures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "pipeline/measure/input/dense_motion.h"
#include "pipeline/measure/input/picture.h"
#include "pipeline/measure/mean.h"
#include "pipeline/measure/mover_regions.h"
#include "pipeline/measure/output_measures.h"

namespace pleinair::measure {
namespace {

constexpr double kAveragingSeconds = 0.65;

constexpr double kMaxStillPercent = 0.2;
constexpr double kMaxReturnLevels = 4.0;
constexpr double kMaxGhost = 0.25;
constexpr double kMaxLostPercent = 15.0;
constexpr double kMaxMoverNHw2 = 0.25;
constexpr double kMaxMoverPopPercent = 2.0;
constexpr double kMaxSeamPopPercent = 3.0;

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
      motion = denseMotion(inputs[t - kShortLag], inputs[t]);
    }
    along.add(inUnits(inputs[t]), inUnits(outputs[t]), movers[t], motion ? &*motion : nullptr);
  }
  return along;
}

}  // namespace

void MoverMeasures::add(const MoverObservation& frame) {
  times_.push_back(frame.time);
  inputs_.push_back(copyOf(frame.input));
  outputs_.push_back(copyOf(frame.output));
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
  StillRegion placed;  // of the input
  StillRegion displaced;
  AveragingPainter average;
  for (std::size_t t = 0; t < inputs_.size(); ++t) {
    const cv::Mat3b& input = inputs_[t];
    const cv::Mat3b averaged = average.paint(times_[t], input);
    const MoverZones zones(movers[t]);
    const MoverZones wrong(laidWrong(movers[t]));
    painting.add({.time = times_[t], .input = input, .output = outputs_[t], .zones = zones});
    averaging.add({.time = times_[t], .input = input, .output = averaged, .zones = zones});
    placed.add({.time = times_[t], .input = input, .output = input, .zones = zones});
    displaced.add({.time = times_[t], .input = input, .output = input, .zones = wrong});
  }
  const MoverMotion motion = areTrue ? *motion_ : alongDenseMotion(inputs_, outputs_, movers);
  MoverReport report{.areMasksTrue = areTrue,
                     .painting = painting.summary(),
                     .alongMotion = {},
                     .averaging = averaging.summary(),
                     .displacedStillPercent = displaced.inputPercent()};
  // Noise alone changes pixels beside movers, too.
  if (report.displacedStillPercent) {
    *report.displacedStillPercent -= placed.inputPercent().value_or(0);
  }
  for (const Subject subject : kAllSubjects) report.alongMotion[subject] = motion.of(subject);
  if (report.painting.coveredPercent == 0) report.displacedStillPercent.reset();
  return report;
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
constexpr const char* kNothingFollowed = "no mover was seen for three frames";
constexpr const char* kNoMover = "no mover was seen";
constexpr const char* kNothingStill = "movers are everywhere";

constexpr Limit kStillLimit{"STILL", " %", kMaxStillPercent, kNothingStill};
constexpr Limit kReturnLimit{"RETURN", "", kMaxReturnLevels, kNothingUncovered};
constexpr Limit kGhostLimit{"GHOST", "", kMaxGhost, kNothingUncovered};
constexpr Limit kLostLimit{"LOST", " %", kMaxLostPercent, kNoClearMover};
constexpr Limit kMoverNHw2Limit{"MOVER nHW2", "", kMaxMoverNHw2, kNothingFollowed};
constexpr Limit kMoverPopLimit{"MOVER POP", " %", kMaxMoverPopPercent, kNothingFollowed};
constexpr Limit kSeamPopLimit{"SEAM POP", " %", kMaxSeamPopPercent, kNothingFollowed};
constexpr Limit kAveragingLost{"LOST of a painter that averages over 0.65 s", " %", kMaxLostPercent,
                               kNoClearMover, false};
constexpr Limit kDisplacedStill{
    "the input's pixels that change more under masks laid wrong by 20 px", " %", kMaxStillPercent,
    kNoMover, false};

/// Half of the limit is left to the painting: a motion along which the input itself reads more says
/// nothing about the marks.
Verdict verdictAlong(const Limit& limit, std::optional<double> value,
                     std::optional<double> ofInput) {
  if (!ofInput || *ofInput <= limit.value / 2) return verdictOf(limit, value);
  Limit unexplained = limit;
  unexplained.missing = "the input itself reads more than half of it";
  return verdictOf(unexplained, std::nullopt);
}

std::vector<Verdict> verdictsAlong(const MoverMotionSummary& painting,
                                   const MoverMotionSummary& input) {
  return {verdictAlong(kMoverNHw2Limit, painting.nHw2, input.nHw2),
          verdictAlong(kMoverPopLimit, painting.popPercent, input.popPercent),
          verdictAlong(kSeamPopLimit, painting.seamPopPercent, input.seamPopPercent)};
}

/// Marks that are redrawn in each frame have to fail at least one of the gates along the motion.
Verdict redrawnVerdict(const MoverMotionSummary& redrawn, const MoverMotionSummary& input) {
  Verdict verdict{.what = "marks redrawn each frame fail MOVER nHW2, MOVER POP or SEAM POP",
                  .found = kNothingFollowed};
  const std::vector<Verdict> gates = verdictsAlong(redrawn, input);
  if (std::ranges::all_of(gates, [](const Verdict& gate) { return !gate.comparison->value; })) {
    verdict.found = gates.front().found;
    return verdict;
  }
  verdict.state = Verdict::State::kFailed;
  verdict.found = "they pass; movers are too plain";
  for (const Verdict& gate : gates) {
    if (gate.state != Verdict::State::kFailed) continue;
    verdict.found = verdict.state == Verdict::State::kPassed ? verdict.found + ", " : "";
    verdict.found += fmt::format("{} fails with {}", gate.what, gate.found);
    verdict.state = Verdict::State::kPassed;
  }
  return verdict;
}

}  // namespace

std::vector<Verdict> moverVerdicts(const MoverReport& movers, bool isOnPaper) {
  const MoverSummary& painting = movers.painting;
  std::vector<Verdict> verdicts{verdictOf(kStillLimit, painting.stillPercent),
                                verdictOf(kReturnLimit, painting.returnLevels),
                                verdictOf(kGhostLimit, painting.ghost)};
  for (Verdict& verdict :
       verdictsAlong(movers.alongMotion[Subject::kPainting], movers.alongMotion[Subject::kInput])) {
    verdicts.push_back(std::move(verdict));
  }
  if (!isOnPaper) verdicts.push_back(verdictOf(kLostLimit, painting.lostPercent));
  return verdicts;
}

std::vector<Verdict> moverControlVerdicts(const MoverReport& movers) {
  return {verdictOf(kAveragingLost, movers.averaging.lostPercent),
          redrawnVerdict(movers.alongMotion[Subject::kFresh], movers.alongMotion[Subject::kInput]),
          verdictOf(kDisplacedStill, movers.displacedStillPercent)};
}

}  // namespace pleinair::measure
