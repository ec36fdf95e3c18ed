#include "pipeline/measure/measurement.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "pipeline/measure/input/picture.h"
#include "pipeline/measure/measurement_report.h"
#include "pipeline/measure/model_gates.h"
#include "pipeline/measure/mover_gates.h"
#include "pipeline/measure/mover_masks.h"
#include "pipeline/measure/sequence_measures.h"

namespace pleinair::measure {
namespace {

constexpr std::uint64_t kMinFrames = kShortLag + 1;

hal::Error unfit(const MeasuredInput& input, std::string problem, std::string remedy) {
  return {.kind = hal::ErrorKind::kInvalidInput,
          .subject = input.description(),
          .problem = std::move(problem),
          .remedy = std::move(remedy)};
}

constexpr std::size_t kMaxWorstFrames = 3;
constexpr std::uint64_t kApartFrames = 8;

/// A high percentile of the channels that differ at all.
double brightLevelOf(const cv::Mat3f& difference) {
  constexpr double kShare = 0.97;
  const cv::Mat1f channels = difference.clone().reshape(1, 1);
  std::vector<float> values(channels.begin(), channels.end());
  std::erase(values, 0.0F);
  if (values.empty()) return 0;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(kShare * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The largest of 1, 2, 5, 10 … that does not saturate the bright differences.
double gainOf(const cv::Mat3f& difference) {
  const double most = 1.0 / std::max(brightLevelOf(difference), 1e-9);
  double gain = 1;
  for (const double step : {2.0, 5.0, 10.0, 20.0, 50.0, 100.0}) {
    if (step <= most) gain = step;
  }
  return gain;
}

/// Keeps the few worst frames of a sequence, some distance apart from each other.
class WorstFrames {
 public:
  void offer(std::uint64_t frame, double ew2, const cv::Mat3f& input, const cv::Mat3f& output,
             const cv::Mat3f& difference);
  /// Worst first.
  std::vector<WorstFrame> frames() const { return frames_; }

 private:
  std::vector<WorstFrame> frames_;
};

void WorstFrames::offer(std::uint64_t frame, double ew2, const cv::Mat3f& input,
                        const cv::Mat3f& output, const cv::Mat3f& difference) {
  const auto near = std::ranges::find_if(
      frames_, [frame](const WorstFrame& each) { return frame - each.frame < kApartFrames; });
  if (near != frames_.end()) {
    if (near->ew2 >= ew2) return;
    frames_.erase(near);
  } else if (frames_.size() == kMaxWorstFrames) {
    if (frames_.back().ew2 >= ew2) return;
    frames_.pop_back();
  }
  const double gain = gainOf(difference);
  cv::Mat3f stronger;
  difference.convertTo(stronger, -1, gain);
  frames_.push_back({.frame = frame,
                     .ew2 = ew2,
                     .input = toImage(input),
                     .output = toImage(output),
                     .difference = toImage(stronger),
                     .differenceGain = gain});
  std::ranges::sort(frames_, std::greater<>(), &WorstFrame::ew2);
}

/// The structuring element that reaches as far as the border is wide.
cv::Mat farSquare() {
  return cv::getStructuringElement(cv::MORPH_RECT, {2 * kBorderPixels + 1, 2 * kBorderPixels + 1});
}

/// One measurement, from the first frame to the report.
class Measurement {
 public:
  Measurement(MeasuredInput& input, MeasuredPainter& painter, const MeasurementOptions& options)
      : input_(input), painter_(painter), options_(options) {}

  hal::Result<std::optional<Report>> run() {
    report_ = {.style = options_.style,
               .settings = options_.settings,
               .input = input_.description(),
               .settled = options_.settle};
    for (auto part : {&Measurement::measureSequence, &Measurement::measureStill}) {
      const hal::Result<Progress> progress = (this->*part)();
      if (!progress) return tl::unexpected(progress.error());
      if (*progress == Progress::kAborted) return std::nullopt;
    }
    judge();
    return std::move(report_);
  }

 private:
  enum class Progress { kDone, kAborted };

  hal::Result<Progress> measureSequence() {
    for (std::uint64_t index = 0;; ++index) {
      if (options_.frames && index == options_.settle + *options_.frames) break;
      const hal::Result<std::optional<hal::CapturedFrame>> frame = input_.next();
      if (!frame) return tl::unexpected(frame.error());
      if (!*frame) break;
      const hal::Result<PaintedFrame> painted = painter_.paint(**frame);
      if (!painted) return tl::unexpected(painted.error());
      if (index >= options_.settle) {
        if (auto added = add(index, *painted); !added) return tl::unexpected(added.error());
        if (options_.isStanding) {
          observeMovers(index, (*frame)->captureTime, *painted);
        }
      }
      if (!options_.goesOn()) return Progress::kAborted;
    }
    if (report_.frames < kMinFrames) {
      return tl::unexpected(unfit(
          input_,
          options_.settle == 0
              ? fmt::format("has only {} frame{}", report_.frames, report_.frames == 1 ? "" : "s")
              : fmt::format("has only {} frames after {} to settle", report_.frames,
                            options_.settle),
          fmt::format("give {} at least, or 11 for all measures; one picture is measured with "
                      "--pan, --zoom, --roll or --still",
                      kMinFrames)));
    }
    return Progress::kDone;
  }

  hal::Result<void> add(std::uint64_t index, const PaintedFrame& painted) {
    const cv::Mat3f input = toFloat(painted.input.view());
    if (report_.frames == 0) {
      report_.size = painted.input.size();
      if (std::min(report_.size.width, report_.size.height) < kMinSidePixels) {
        return tl::unexpected(
            unfit(input_, fmt::format("has frames of {}x{} px", input.cols, input.rows),
                  fmt::format("give frames of {0}x{0} px at least", kMinSidePixels)));
      }
      start(painted, input);
    }
    ++report_.frames;
    if (models_) models_->add(index, *painted.models);
    const cv::Mat3f output = toFloat(painted.output.view());
    if (auto added = sequence_->add(index, input, output, painted.anchors); !added) return added;
    report_.overTime.push_back(valuesOfLast(index));
    if (const std::optional<double> ew2 = report_.overTime.back().painting.ew2) {
      worst_.offer(index, *ew2, input, output, sequence_->of(Subject::kPainting).lastDifference());
    }
    return {};
  }

  void start(const PaintedFrame& first, const cv::Mat3f& input) {
    TrueMotion* const ofCamera = input_.motion();
    if (first.models) models_.emplace(ofCamera);
    TrueMotion* const motion = models_ && ofCamera != nullptr ? &*models_ : ofCamera;
    sequence_.emplace(input.size(), motion, models_ ? &*models_ : nullptr);
    still_ = models_ ? toFloat(first.camera.view()) : input;
  }

  void observeMovers(std::uint64_t index, hal::TimePoint time, const PaintedFrame& painted) {
    TrueMovers* const truth = input_.movers();
    movers_.add({.time = time,
                 .input = painted.input,
                 .output = painted.output,
                 .trueMovers = truth == nullptr ? cv::Mat1b() : truth->mask(index),
                 .trueMotion = truth == nullptr ? nullptr : sequence_->lastMotion()});
    if (truth == nullptr || !painted.movers) return;
    if (!labels_) labels_.emplace();
    labels_->add(index, time, toLevels(painted.movers->view()), movers_.lastTrueMovers());
    report_.overTime.back().labelIou = labels_->lastIou();
  }

  FrameValues valuesOfLast(std::uint64_t index) const {
    const OutputMeasures::Frame& painting = sequence_->of(Subject::kPainting).frames().back();
    const OutputMeasures::Frame& input = sequence_->of(Subject::kInput).frames().back();
    FrameValues values{.frame = index,
                       .painting = OutputMeasures::valuesOf(painting, input),
                       .input = OutputMeasures::valuesOf(input, input),
                       .anchors = {}};
    const std::vector<AnchorFrame>& anchors = sequence_->anchors().frames();
    if (!anchors.empty()) values.anchors = anchors.back();
    return values;
  }

  hal::Result<Progress> measureStill() {
    if (options_.stillFrames == 0) return Progress::kDone;
    painter_.reset();
    StillMeasures still(still_.size());
    AnchorMeasures anchors(still_.size());
    LabelMeasures labels;
    for (std::uint64_t i = 0; i < options_.stillSettle + options_.stillFrames; ++i) {
      const hal::Image noisy = withSensorNoise(still_, options_.stillNoiseLevels, i);
      const hal::TimePoint time{kFramePeriod * static_cast<std::int64_t>(i)};
      const hal::Result<PaintedFrame> painted =
          painter_.paint({.image = noisy.view(),
                          .sequence = i,
                          .captureTime = time,
                          .timestampSource = hal::TimestampSource::kSimulated});
      if (!painted) return tl::unexpected(painted.error());
      if (i >= options_.stillSettle) {
        // Models may move on their own, and follow a pose that noise moves, with their shadows.
        std::optional<cv::Mat1b> models;
        if (painted->models) models = grown(painted->models->changed, kFarPixels);
        const cv::Mat1b* const ignored = models ? &*models : nullptr;
        still.add(toFloat(painted->input.view()), toFloat(painted->output.view()), ignored);
        // Cells of the coarsest marks reach further than what is seen to change.
        if (models) cv::dilate(painted->models->changed, *models, farSquare());
        if (!painted->anchors.empty()) anchors.add(painted->anchors, nullptr, nullptr, ignored);
        if (options_.isStanding && painted->movers) {
          const cv::Mat1b nothingMoves(still_.size(), 0);
          labels.add(i, time, toLevels(painted->movers->view()), nothingMoves);
        }
      }
      if (!options_.goesOn()) return Progress::kAborted;
    }
    report_.stillFrames = options_.stillFrames;
    report_.insideStill = anchors.total();
    report_.labelFlipsOnStillPercent = labels.total().flipsPercent;
    report_.stillNoise = options_.stillNoiseLevels;
    for (const Subject subject : kAllSubjects) flicker_[subject] = still.flicker(subject);
    return Progress::kDone;
  }

  void judge() {
    report_.motionKind = sequence_->motionKind();
    report_.motion = models_                      ? models_->description()
                     : input_.motion() == nullptr ? "its motion is not known"
                                                  : input_.motion()->description();
    report_.measures = sequence_->totals();
    for (const Subject subject : kAllSubjects) report_.measures[subject].xFlk = flicker_[subject];
    report_.flatness = sequence_->flatness();
    report_.inside = sequence_->anchors().total();
    report_.worst = worst_.frames();
    report_.notices = input_.notices();
    if (options_.frames && report_.frames < *options_.frames) {
      report_.notices.push_back(
          fmt::format("the input ended: of {} frames that were asked for {} "
                      "are measured",
                      *options_.frames, report_.frames));
    }
    report_.leftOut = leftOut();
    report_.controls = controlVerdicts(report_.measures, options_.coherence, runConditions(),
                                       sequence_->displacedXEw2());
    const std::vector<styles::CoherenceGate> judged = judgedGates();
    styles::CoherenceGates gates = options_.coherence;
    gates.gates = judged;
    report_.gates = gateVerdicts(gates, runConditions(), report_.measures[Subject::kPainting],
                                 report_.measures[Subject::kFixed]);
    if (options_.isStanding) judgeMovers();
    if (models_) judgeModels();
    for (Verdict& verdict : anchorVerdicts(options_.coherence, report_.motionKind, settledAnchors(),
                                           report_.insideStill)) {
      report_.gates.push_back(std::move(verdict));
    }
  }

  /// Before a standing camera only those that hold under any motion.
  std::vector<styles::CoherenceGate> judgedGates() const {
    std::vector<styles::CoherenceGate> judged;
    std::ranges::copy_if(options_.coherence.gates, std::back_inserter(judged),
                         [this](const auto& gate) {
                           return !options_.isStanding || gate.motion == styles::GateMotion::kAny;
                         });
    return judged;
  }

  void judgeMovers() {
    report_.movers = movers_.total();
    if (!report_.movers) return;
    const MoverMarks marks{.areOnPaper = options_.isOnPaper,
                           .areLines = options_.coherence.drawsLines};
    for (Verdict& verdict : moverControlVerdicts(*report_.movers, marks)) {
      report_.controls.push_back(std::move(verdict));
    }
    for (Verdict& verdict : moverVerdicts(*report_.movers, marks)) {
      report_.gates.push_back(std::move(verdict));
    }
    judgeLabels();
  }

  void judgeModels() {
    report_.models = ModelReport{.regions = sequence_->regions().summary(),
                                 .forgettingRatio = sequence_->regions().forgettingRatio(),
                                 .anchors = sequence_->anchorsOnModels().summary()};
    for (Verdict& verdict : modelControlVerdicts(*report_.models, options_.coherence)) {
      report_.controls.push_back(std::move(verdict));
    }
    for (Verdict& verdict : modelVerdicts(*report_.models, options_.coherence)) {
      report_.gates.push_back(std::move(verdict));
    }
  }

  void judgeLabels() {
    if (!labels_ && !report_.labelFlipsOnStillPercent) return;  // it tells no movers
    if (labels_) report_.labels = labels_->total();
    for (Verdict& verdict : labelVerdicts(report_.labels, report_.labelFlipsOnStillPercent)) {
      report_.gates.push_back(std::move(verdict));
    }
    if (!labels_) return;
    for (Verdict& verdict : labelControlVerdicts(*report_.labels)) {
      report_.controls.push_back(std::move(verdict));
    }
  }

  RunConditions runConditions() const {
    return {.motion = report_.motionKind,
            .frames = report_.frames,
            .stillFrames = report_.stillFrames,
            .stillNoiseLevels = report_.stillNoise};
  }

  /// Summary of the frames from two seconds after the first on.
  std::optional<AnchorSummary> settledAnchors() const {
    constexpr std::uint64_t kTwoSeconds = 60;
    const std::uint64_t firstCompared = options_.settle + 1;
    const std::uint64_t skipped = firstCompared < kTwoSeconds ? kTwoSeconds - firstCompared : 0;
    return sequence_->anchors().total(skipped);
  }

  std::vector<std::string> leftOut() const {
    std::vector<std::string> lines =
        missingLines(report_.measures[Subject::kPainting], runConditions());
    if (!report_.flatness) {
      lines.emplace_back(
          "flatness: it compares near and far views, and the picture's scale is not "
          "known to change by 15 %");
    }
    if (!report_.inside) lines.emplace_back("inside: this style has no anchors");
    return lines;
  }

  MeasuredInput& input_;
  MeasuredPainter& painter_;
  const MeasurementOptions& options_;
  Report report_;
  std::optional<ModelMotion> models_;  // if the pictures show any
  std::optional<SequenceMeasures> sequence_;
  MoverMeasures movers_;
  std::optional<LabelMeasures> labels_;
  WorstFrames worst_;
  cv::Mat3f still_;
  PerSubject<std::optional<double>> flicker_;
};

}  // namespace

std::optional<std::uint64_t> framesToPaint(const MeasuredInput& input,
                                           const MeasurementOptions& options) {
  const std::uint64_t still =
      options.stillFrames == 0 ? 0 : options.stillFrames + options.stillSettle;
  std::optional<std::uint64_t> moving = input.frameCount();
  if (options.frames) {
    const std::uint64_t wanted = options.settle + *options.frames;
    moving = moving ? std::min(*moving, wanted) : wanted;
  }
  if (!moving) return std::nullopt;
  return *moving + still;
}

hal::Result<std::optional<Report>> measure(MeasuredInput& input, MeasuredPainter& painter,
                                           const MeasurementOptions& options) {
  return Measurement(input, painter, options).run();
}

}  // namespace pleinair::measure
