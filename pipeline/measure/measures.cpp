#include "pipeline/measure/measures.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "pipeline/measure/output_measures.h"

namespace pleinair::measure {

std::span<const MeasureColumn> measureColumns() {
  static constexpr std::array kColumns{
      MeasureColumn{
          &Measures::ew2, "EW2", "ew2", "{:.3f}", "mean square × 1000",
          "difference along the motion, lag 2, ×1000; 0 is perfect, blurring is rewarded"},
      MeasureColumn{&Measures::xEw2, "xEW2", "xew2", "{:.2f}", "of the input's",
                    "EW2 over the input's: 1 is as noisy as the camera"},
      MeasureColumn{&Measures::nHw2, "nHW2", "nhw2", "{:.3f}", "of the misaligned",
                    "0: marks follow the image; 1: marks are unrelated between frames"},
      MeasureColumn{&Measures::popPercent, "POP %", "pop_percent", "{:.2f}", "% of the pixels",
                    "pixels that change by more than 24 levels along the motion"},
      MeasureColumn{&Measures::s10Percent, "S10 %", "s10_percent", "{:.1f}", "% of the marks",
                    "marks found again ten frames later"},
      MeasureColumn{
          &Measures::scr, "SCR", "scr", "{:.3f}", "correlation",
          "content that stays on the screen while the image moves: the shower-door effect"},
      MeasureColumn{&Measures::xFlk, "xFLK", "xflk", "{:.3f}", "of the input's",
                    "flicker of a still scene over the camera's noise: 1 passes it through"},
      MeasureColumn{&Measures::dep, "DEP", "dep", "{:.1f}", "levels",
                    "distance from the photograph in levels, apart from a tone curve"},
      MeasureColumn{&Measures::det, "DET", "det", "{:.2f}", "of the input's",
                    "detail kept of the photograph's"},
  };
  return kColumns;
}

std::string textOf(const MeasureColumn& column, const Measures& measures) {
  const std::optional<double>& value = measures.*column.value;
  return value ? fmt::format(fmt::runtime(column.format), *value) : "–";
}

namespace {

using Measure = std::optional<double> Measures::*;

bool needsMotion(Measure measure) {
  return measure == &Measures::ew2 || measure == &Measures::xEw2 || measure == &Measures::nHw2 ||
         measure == &Measures::popPercent || measure == &Measures::s10Percent;
}

bool needsLongLag(Measure measure) {
  return measure == &Measures::s10Percent || measure == &Measures::scr;
}

}  // namespace

std::string reasonMissing(Measure measure, const RunConditions& runConditions) {
  if (needsMotion(measure) && runConditions.motion == MotionKind::kNone) {
    return "it needs the true motion (motion.json, flow files, or --motion)";
  }
  if (needsLongLag(measure) && runConditions.frames <= kLongLag) {
    return fmt::format("it compares frames {} apart, and there are {}", kLongLag,
                       runConditions.frames);
  }
  if (measure == &Measures::scr) {
    return "too little of the picture moves by 8 px or more in ten frames";
  }
  if (measure == &Measures::xFlk) {
    if (runConditions.stillFrames < 2) return "no still scene was painted";
    if (runConditions.stillNoiseLevels == 0) return "the still scene has no noise (--noise 0)";
    return "the noise does not show on the still scene";
  }
  if (measure == &Measures::xEw2) return "nothing could be compared, or the input has no error";
  if (measure == &Measures::dep || measure == &Measures::det) return "the input has no detail";
  return "nothing could be compared along the motion";
}

std::vector<std::string> missingLines(const Measures& measures,
                                      const RunConditions& runConditions) {
  std::vector<std::pair<std::string, std::string>> namesOfReason;
  for (const MeasureColumn& column : measureColumns()) {
    if (measures.*column.value) continue;
    const std::string reason = reasonMissing(column.value, runConditions);
    const auto known =
        std::ranges::find(namesOfReason, reason, &std::pair<std::string, std::string>::first);
    if (known == namesOfReason.end()) {
      namesOfReason.emplace_back(reason, column.name);
    } else {
      known->second += fmt::format(", {}", column.name);
    }
  }
  std::vector<std::string> lines;
  lines.reserve(namesOfReason.size());
  for (const auto& [reason, names] : namesOfReason) lines.push_back(names + ": " + reason);
  return lines;
}

}  // namespace pleinair::measure
