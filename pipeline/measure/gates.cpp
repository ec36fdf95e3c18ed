#include "pipeline/measure/gates.h"

#include <algorithm>

#include <fmt/format.h>

namespace pleinair::measure {
namespace {

using styles::CoherenceGate;
using styles::CoherenceMeasure;
using styles::GateMotion;

std::optional<double> Measures::*memberOf(CoherenceMeasure measure) {
  switch (measure) {
    case CoherenceMeasure::kEw2:
      return &Measures::ew2;
    case CoherenceMeasure::kXEw2:
      return &Measures::xEw2;
    case CoherenceMeasure::kNHw2:
      return &Measures::nHw2;
    case CoherenceMeasure::kPop:
      return &Measures::popPercent;
    case CoherenceMeasure::kS10:
      return &Measures::s10Percent;
    case CoherenceMeasure::kScr:
      return &Measures::scr;
    case CoherenceMeasure::kXFlk:
      return &Measures::xFlk;
    case CoherenceMeasure::kDep:
      return &Measures::dep;
    case CoherenceMeasure::kDet:
      return &Measures::det;
  }
  return nullptr;
}

bool isJudgedOn(const CoherenceGate& gate, MotionKind motion) {
  switch (gate.motion) {
    case GateMotion::kAny:
      return true;
    case GateMotion::kPan:  // if the motion is unknown, the gate counts as not measured and not
                            // passed
      return motion != MotionKind::kOther;
    case GateMotion::kOtherKnown:
      return motion == MotionKind::kOther;
    case GateMotion::kMoving:
      return motion != MotionKind::kStill;
  }
  return false;
}

const MeasureColumn& columnOf(std::optional<double> Measures::*value) {
  return *std::ranges::find(measureColumns(), value, &MeasureColumn::value);
}

Verdict judge(const CoherenceGate& gate, const RunConditions& runConditions,
              const Measures& measures, const Measures& tiling) {
  std::optional<double> Measures::*const measure = memberOf(gate.measure);
  const MeasureColumn& column = columnOf(measure);
  const bool isUpperLimit = gate.side == CoherenceGate::Side::kMax;
  const char* relation = isUpperLimit ? "≤" : "≥";
  const std::optional<double>& found = measures.*measure;
  double limit = gate.limit;
  bool isLimitKnown = true;
  Verdict verdict{.what = fmt::format("{} {} {:g}", column.name, relation, gate.limit),
                  .found = textOf(column, measures)};
  if (gate.isOfTiling) {
    const std::optional<double>& reference = tiling.*measure;
    limit *= reference.value_or(0);
    isLimitKnown = reference.has_value();
    verdict.what += fmt::format(" × the tiling's {}", textOf(column, tiling));
  }
  verdict.comparison = {.value = found, .limit = {}, .isUpperLimit = isUpperLimit};
  if (isLimitKnown) verdict.comparison->limit = limit;
  if (!found) verdict.found = reasonMissing(measure, runConditions);
  if (found && !isLimitKnown) verdict.found += ", but the tiling's is not known";
  if (!found || !isLimitKnown) return verdict;
  const bool isPassed = isUpperLimit ? *found <= limit : *found >= limit;
  verdict.state = isPassed ? Verdict::State::kPassed : Verdict::State::kFailed;
  return verdict;
}

}  // namespace

std::vector<Verdict> gateVerdicts(const styles::CoherenceGates& gates,
                                  const RunConditions& runConditions, const Measures& measures,
                                  const Measures& tiling) {
  std::vector<Verdict> verdicts;
  for (const CoherenceGate& gate : gates.gates) {
    if (!isJudgedOn(gate, runConditions.motion)) continue;
    verdicts.push_back(judge(gate, runConditions, measures, tiling));
  }
  return verdicts;
}

std::vector<Verdict> anchorVerdicts(const styles::CoherenceGates& gates, MotionKind motion,
                                    const std::optional<AnchorSummary>& settled,
                                    const std::optional<AnchorSummary>& still) {
  using State = Verdict::State;
  constexpr double kMaxTurnoverPercent = 0.5;
  std::vector<Verdict> verdicts;
  if (!gates.holdsAnchors) return verdicts;
  if (motion == MotionKind::kPan) {
    Verdict turnover{.what = "births and deaths away from the border ≤ 0.5 % of the marks a frame",
                     .found = "no anchors after two seconds",
                     .comparison = Verdict::Comparison{.value = {}, .limit = kMaxTurnoverPercent}};
    if (settled) {
      const bool isPassed = settled->innerTurnoverPercent <= kMaxTurnoverPercent;
      turnover.state = isPassed ? State::kPassed : State::kFailed;
      turnover.comparison->value = settled->innerTurnoverPercent;
      turnover.found = fmt::format("{:.2f} %", settled->innerTurnoverPercent);
    }
    verdicts.push_back(std::move(turnover));
  }
  Verdict quiet{.what = "no births or deaths on a still scene",
                .found = "no anchors",
                .comparison = Verdict::Comparison{.value = {}, .limit = 0.0}};
  if (still) {
    quiet.state = still->births + still->deaths == 0 ? State::kPassed : State::kFailed;
    quiet.comparison->value = still->births + still->deaths;
    quiet.found =
        fmt::format("{:.2f} births and {:.2f} deaths a frame", still->births, still->deaths);
  }
  verdicts.push_back(std::move(quiet));
  return verdicts;
}

}  // namespace pleinair::measure
