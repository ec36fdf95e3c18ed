#include "pipeline/measure/negative_controls.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "pipeline/measure/picture.h"

namespace pleinair::measure {
namespace {

using State = Verdict::State;

constexpr std::uint64_t kFixedSeed = 0;
constexpr double kLeastScreenPattern = 0.25;
/// Carried pictures read up to 0.1, those under a wrong motion 0.8 and more.
constexpr double kMostInputError = 0.5;
/// Below this, in levels, tiles are hardly seen: there is nothing to tell one from the next by.
constexpr double kSmoothDeviation = 3.0;

/// Marks that are redrawn in each frame must fail one of these, where the style has no gates.
constexpr std::array kReferenceGates{
    styles::CoherenceGate{styles::CoherenceMeasure::kNHw2, styles::CoherenceGate::Side::kMost, 0.2},
    styles::CoherenceGate{styles::CoherenceMeasure::kS10, styles::CoherenceGate::Side::kLeast, 80},
    styles::CoherenceGate{styles::CoherenceMeasure::kXFlk, styles::CoherenceGate::Side::kMost, 0.5},
    styles::CoherenceGate{styles::CoherenceMeasure::kDet, styles::CoherenceGate::Side::kLeast,
                          0.75},
};

/// Why a control may read wrong though the measures are sound.
std::string likelyCause(const PerSubject<Measures>& measures) {
  const std::optional<double>& deviation = measures[Subject::kFixed].dep;
  if (deviation && *deviation < kSmoothDeviation) {
    return fmt::format("; the input is too smooth: tiles of it differ from it by {:.1f} levels",
                       *deviation);
  }
  return "";
}

Verdict inputVerdict(const Measures& input) {
  constexpr double kTolerance = 1e-6;
  Verdict verdict{.what = "the input itself reads xEW2 = 1"};
  if (!input.ew2) {
    verdict.found = "nothing to compare along a true motion";
  } else if (!input.xEw2) {
    verdict.found = "the input has no error at all: it has no noise";
  } else {
    verdict.found = fmt::format("{:.4f}", *input.xEw2);
    verdict.state = std::abs(*input.xEw2 - 1) < kTolerance ? State::kPassed : State::kFailed;
  }
  return verdict;
}

/// xEW2 = 1 says that the measures agree with themselves, not that the motion is the pictures': of
/// another motion even the input is not carried along.
Verdict motionVerdict(const PerSubject<Measures>& measures) {
  Verdict verdict{.what =
                      fmt::format("the input goes along with the motion that is told: nHW2 ≤ {:g}",
                                  kMostInputError)};
  const std::optional<double>& carried = measures[Subject::kInput].nHw2;
  verdict.comparison = {.value = carried, .limit = kMostInputError, .isMost = true};
  if (!carried) {
    verdict.found = "nothing to compare along a true motion";
    return verdict;
  }
  const bool isPassed = *carried <= kMostInputError;
  verdict.state = isPassed ? State::kPassed : State::kFailed;
  verdict.found = fmt::format("{:.3f}", *carried);
  if (isPassed) return verdict;
  const std::string smooth = likelyCause(measures);
  verdict.found += smooth.empty() ? "; the motion is another, or noise hides it" : smooth;
  return verdict;
}

Verdict freshVerdict(const PerSubject<Measures>& measures, const styles::CoherenceGates& gates,
                     const RunConditions& runConditions) {
  Verdict verdict{.what = "marks redrawn each frame fail the gates"};
  bool isMeasured = false;
  for (const Verdict& gate :
       gateVerdicts(gates, runConditions, measures[Subject::kFresh], measures[Subject::kFixed])) {
    isMeasured |= gate.state != State::kNotMeasured;
    if (gate.state != State::kFailed) continue;
    verdict.state = State::kPassed;
    verdict.found +=
        fmt::format("{}{} fails with {}", verdict.found.empty() ? "" : ", ", gate.what, gate.found);
  }
  if (verdict.state == State::kPassed) return verdict;
  verdict.state = isMeasured ? State::kFailed : State::kNotMeasured;
  verdict.found = (isMeasured ? "they pass" : "no gate could be measured") + likelyCause(measures);
  return verdict;
}

Verdict fixedVerdict(const PerSubject<Measures>& measures, const RunConditions& runConditions) {
  Verdict verdict{
      .what = fmt::format("marks fixed to the screen read SCR ≥ {:g}", kLeastScreenPattern)};
  const std::optional<double>& screen = measures[Subject::kFixed].scr;
  verdict.comparison = {.value = screen, .limit = kLeastScreenPattern, .isMost = false};
  if (!screen) {
    verdict.found = "SCR: " + whyMissing(&Measures::scr, runConditions);
    return verdict;
  }
  const bool isPassed = *screen >= kLeastScreenPattern;
  verdict.state = isPassed ? State::kPassed : State::kFailed;
  verdict.found = fmt::format("{:.3f}", *screen) + (isPassed ? "" : likelyCause(measures));
  return verdict;
}

/// Of whole levels, as every painting is.
cv::Mat3f inLevels(const cv::Mat3f& picture) {
  return toFloat(toImage(picture).view());
}

}  // namespace

ControlPainter::ControlPainter(cv::Size size) : fixed_(size, kFixedSeed) {}

PerSubject<cv::Mat3f> ControlPainter::paint(const cv::Mat3f& input, const cv::Mat3f& output,
                                            std::uint64_t index) const {
  PerSubject<cv::Mat3f> pictures;
  pictures[Subject::kPainting] = output;
  pictures[Subject::kInput] = input;
  pictures[Subject::kFresh] =
      inLevels(VoronoiTiling(input.size(), kFixedSeed + 1 + index).paint(input));
  pictures[Subject::kFixed] = inLevels(fixed_.paint(input));
  return pictures;
}

std::vector<Verdict> controlVerdicts(const PerSubject<Measures>& measures,
                                     const styles::CoherenceGates& gates,
                                     const RunConditions& runConditions) {
  const styles::CoherenceGates judged =
      gates.empty() ? styles::CoherenceGates{kReferenceGates} : gates;
  return {inputVerdict(measures[Subject::kInput]), motionVerdict(measures),
          freshVerdict(measures, judged, runConditions), fixedVerdict(measures, runConditions)};
}

}  // namespace pleinair::measure
