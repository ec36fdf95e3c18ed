#include "pipeline/measure/gates.h"

#include <algorithm>
#include <array>
#include <cassert>

#include <fmt/format.h>

namespace pleinair::measure {
namespace {

/// Motions for which a gate is evaluated.
enum class On {
  kAny,
  kPan,         ///< one vector, which may be zero; not measured where the motion is unknown
  kOtherKnown,  ///< motion other than one global translation
  kMoving,      ///< known or not
};

struct Gate {
  std::string_view style;
  std::optional<double> Measures::*measure;
  bool isUpperLimit;  ///< true: upper limit; false: lower limit
  double limit;       ///< or the factor of the reference that follows
  std::optional<double> Measures::*ofTiling = nullptr;
  On on = On::kAny;
};

constexpr std::array kGates{
    Gate{"painterly", &Measures::ew2, true, 0.6, nullptr, On::kPan},
    Gate{"painterly", &Measures::nHw2, true, 0.10, nullptr, On::kPan},
    Gate{"painterly", &Measures::nHw2, true, 0.20, nullptr, On::kOtherKnown},
    Gate{"painterly", &Measures::s10Percent, false, 90, nullptr, On::kPan},
    Gate{"painterly", &Measures::s10Percent, false, 80, nullptr, On::kOtherKnown},
    Gate{"painterly", &Measures::popPercent, true, 1, nullptr, On::kPan},
    Gate{"painterly", &Measures::xFlk, true, 0.5},
    Gate{"painterly", &Measures::dep, false, 0.75, &Measures::dep},
    Gate{"painterly", &Measures::det, false, 0.75},
    Gate{"watercolor", &Measures::nHw2, true, 0.30},
    Gate{"watercolor", &Measures::xFlk, true, 0.15},
    Gate{"watercolor", &Measures::dep, false, 0.75, &Measures::dep},
    Gate{"watercolor", &Measures::scr, true, 0.3, &Measures::scr, On::kMoving},
};

bool isShutOn(const Gate& gate, MotionKind motion) {
  switch (gate.on) {
    case On::kAny:
      return true;
    case On::kPan:  // if the motion is unknown, the gate counts as not measured and not passed
      return motion != MotionKind::kOther;
    case On::kOtherKnown:
      return motion == MotionKind::kOther;
    case On::kMoving:
      return motion != MotionKind::kStill;
  }
  return false;
}

const MeasureColumn& columnOf(std::optional<double> Measures::*value) {
  return *std::ranges::find(measureColumns(), value, &MeasureColumn::value);
}

Verdict judge(const Gate& gate, const RunConditions& runConditions, const Measures& measures,
              const Measures& tiling) {
  const MeasureColumn& column = columnOf(gate.measure);
  const char* relation = gate.isUpperLimit ? "≤" : "≥";
  const std::optional<double>& found = measures.*gate.measure;
  double limit = gate.limit;
  bool isLimitKnown = true;
  Verdict verdict{.what = fmt::format("{} {} {:g}", column.name, relation, gate.limit),
                  .found = textOf(column, measures)};
  if (gate.ofTiling != nullptr) {
    const std::optional<double>& reference = tiling.*gate.ofTiling;
    limit *= reference.value_or(0);
    isLimitKnown = reference.has_value();
    verdict.what += fmt::format(" × the tiling's {}", textOf(column, tiling));
  }
  verdict.comparison = {.value = found, .limit = {}, .isUpperLimit = gate.isUpperLimit};
  if (isLimitKnown) verdict.comparison->limit = limit;
  if (!found) verdict.found = reasonMissing(gate.measure, runConditions);
  if (found && !isLimitKnown) verdict.found += ", but the tiling's is not known";
  if (!found || !isLimitKnown) return verdict;
  const bool isPassed = gate.isUpperLimit ? *found <= limit : *found >= limit;
  verdict.state = isPassed ? Verdict::State::kPassed : Verdict::State::kFailed;
  return verdict;
}

}  // namespace

bool hasGates(std::string_view style) {
  return std::ranges::find(kGates, style, &Gate::style) != kGates.end();
}

std::vector<std::string> gatedStyles() {
  std::vector<std::string> styles;
  for (const Gate& gate : kGates) {
    if (styles.empty() || styles.back() != gate.style) styles.emplace_back(gate.style);
  }
  return styles;
}

std::vector<Verdict> gateVerdicts(std::string_view style, const RunConditions& runConditions,
                                  const Measures& measures, const Measures& tiling) {
  assert(hasGates(style));
  std::vector<Verdict> verdicts;
  for (const Gate& gate : kGates) {
    if (gate.style != style || !isShutOn(gate, runConditions.motion)) continue;
    verdicts.push_back(judge(gate, runConditions, measures, tiling));
  }
  return verdicts;
}

std::vector<Verdict> anchorVerdicts(std::string_view style, MotionKind motion,
                                    const std::optional<AnchorSummary>& settled,
                                    const std::optional<AnchorSummary>& still) {
  using State = Verdict::State;
  constexpr double kMaxTurnoverPercent = 0.5;
  std::vector<Verdict> verdicts;
  if (style != "painterly") return verdicts;
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
