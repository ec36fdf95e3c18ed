#include "pipeline/measure/run_conditions.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "pipeline/measure/output_measures.h"

namespace pleinair::measure {
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
  for (const auto& [reason, names] : namesOfReason) lines.push_back(names + ": " + reason);
  return lines;
}

}  // namespace pleinair::measure
