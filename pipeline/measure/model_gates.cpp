#include "pipeline/measure/model_gates.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "pipeline/measure/limit_verdict.h"

namespace pleinair::measure {
namespace {

using State = Verdict::State;
using styles::CoherenceGate;
using styles::CoherenceGates;
using styles::CoherenceMeasure;
using styles::GateMotion;

constexpr double kMaxNHw2 = 0.2;
constexpr double kMinS10Percent = 80;
constexpr double kMaxPopPercent = 2.0;
constexpr double kMaxOutlinePopPercent = 3.0;
constexpr double kMaxSlipPixels = 0.05;
constexpr double kMaxTurnoverPercent = 2.0;
constexpr double kMaxInputNHw2 = 0.5;
/// The right motion reads more than 1, the wrong one less. Shading stays where it is while a plain
/// limb turns below it, so that the right one is not free of error: it reads 1.7 on a white figure,
/// 7 on the gearbox, 24 to 40 on the fox.
constexpr double kMinForgettingRatio = 1.25;

constexpr const char* kNothingReal = "the camera's motion is not known, or nothing of it is seen";
constexpr const char* kNothingVirtual =
    "no model was seen far enough from outlines for as many frames";
constexpr const char* kNoSeam = "no model was seen, or the camera's motion is not known";
constexpr const char* kNoAnchors = "no mark was on a model for two frames";
constexpr const char* kNothingMoves = "no model moves by 2 px in two frames";

constexpr Limit kModelsFollow{"the input follows the models' motion: VIRTUAL nHW2", "",
                              kMaxInputNHw2, kNothingVirtual};
constexpr Limit kForgetting{
    "motion that forgets the models: the input's EW2 on them, of that along the true motion", "",
    kMinForgettingRatio,
    "no model with detail moves by 2 px in two frames against what is behind it", false};

/// The limit that a style sets under motion that is known, but not one vector.
double limitOf(const CoherenceGates& gates, CoherenceMeasure measure, double otherwise) {
  const auto isMeant = [measure](const CoherenceGate& gate) {
    return gate.measure == measure && !gate.isOfTiling && gate.motion != GateMotion::kPan;
  };
  const auto gate = std::ranges::find_if(gates.gates, isMeant);
  return gate == gates.gates.end() ? otherwise : gate->limit;
}

/// The limits of a region.
struct RegionLimits {
  Limit nHw2, s10, pop;
};

RegionLimits limitsOf(const CoherenceGates& gates, Region region) {
  const bool isReal = region == Region::kReal;
  const char* const missing = isReal ? kNothingReal : kNothingVirtual;
  return {.nHw2 = {isReal ? "REAL nHW2" : "VIRTUAL nHW2", "",
                   limitOf(gates, CoherenceMeasure::kNHw2, kMaxNHw2), missing},
          .s10 = {isReal ? "REAL S10" : "VIRTUAL S10", " %",
                  limitOf(gates, CoherenceMeasure::kS10, kMinS10Percent), missing, false, true},
          .pop = {isReal ? "REAL POP" : "VIRTUAL POP", " %",
                  limitOf(gates, CoherenceMeasure::kPop, kMaxPopPercent), missing}};
}

/// A painting need not be calmer than what it paints: where the input itself reads worse than the
/// limit (outlines within models are not smoothed, shadows move), its reading is the limit.
Verdict verdictOrInputs(Limit limit, std::optional<double> value, std::optional<double> ofInput) {
  const bool isWorse = ofInput && (limit.isUpper ? *ofInput > limit.value : *ofInput < limit.value);
  if (!isWorse) return verdictOf(limit, value);
  const Verdict own = verdictOf(limit, value);
  // Equal to the input's is good enough, and rounding decides nothing.
  limit.value = *ofInput + (limit.isUpper ? 1e-9 : -1e-9);
  Verdict verdict = verdictOf(limit, value);
  verdict.what = fmt::format("{}, or the input's {:.3g}{}", own.what, *ofInput, limit.unit);
  return verdict;
}

std::vector<Verdict> regionVerdicts(const RegionLimits& limits, const RegionSummary& painting,
                                    const RegionSummary& input) {
  return {verdictOrInputs(limits.nHw2, painting.nHw2, input.nHw2),
          verdictOrInputs(limits.pop, painting.popPercent, input.popPercent),
          verdictOrInputs(limits.s10, painting.s10Percent, input.s10Percent)};
}

std::vector<Verdict> slipVerdicts(const std::optional<ModelAnchorSummary>& anchors) {
  const auto value = [&anchors](auto read) {
    return anchors ? read(*anchors) : std::optional<double>();
  };
  return {
      verdictOf({"slip of marks on models, 95 %", " px a frame", kMaxSlipPixels, kNoAnchors},
                value([](const ModelAnchorSummary& each) {
                  return each.slip ? std::optional(each.slip->percentile95) : std::nullopt;
                })),
      verdictOf({"births and deaths on models that stay in sight, beyond their change of size",
                 " % of the marks a frame", kMaxTurnoverPercent, kNoAnchors},
                value([](const ModelAnchorSummary& each) {
                  return std::optional(std::max(each.turnoverPercent - each.resizedPercent, 0.0));
                }))};
}

/// A control has to fail at least one of the gates of models.
Verdict controlVerdict(std::string what, const std::vector<Verdict>& gates, const char* missing) {
  Verdict verdict{.what = std::move(what), .found = missing};
  for (const Verdict& gate : gates) {
    if (gate.state == State::kNotMeasured) continue;
    if (verdict.state == State::kNotMeasured) {
      verdict.state = State::kFailed;
      verdict.found = "they pass; the models are too plain";
    }
    if (gate.state != State::kFailed) continue;
    verdict.found = verdict.state == State::kPassed ? verdict.found + ", " : "";
    verdict.found += fmt::format("{} fails with {}", gate.what, gate.found);
    verdict.state = State::kPassed;
  }
  return verdict;
}

}  // namespace

std::vector<Verdict> modelVerdicts(const ModelReport& models, const CoherenceGates& gates) {
  std::vector<Verdict> verdicts;
  const auto add = [&verdicts](std::vector<Verdict> more) {
    for (Verdict& verdict : more) verdicts.push_back(std::move(verdict));
  };
  for (const Region region : {Region::kReal, Region::kVirtual}) {
    const auto& of = models.regions[region];
    add(regionVerdicts(limitsOf(gates, region), of[Subject::kPainting], of[Subject::kInput]));
  }
  const auto& seam = models.regions[Region::kSeam];
  verdicts.push_back(verdictOrInputs({"SEAM POP", " %", kMaxOutlinePopPercent, kNoSeam},
                                     seam[Subject::kPainting].popPercent,
                                     seam[Subject::kInput].popPercent));
  if (gates.holdsAnchors) add(slipVerdicts(models.anchors));
  return verdicts;
}

std::vector<Verdict> modelControlVerdicts(const ModelReport& models, const CoherenceGates& gates) {
  const RegionLimits limits = limitsOf(gates, Region::kVirtual);
  const auto& all = models.regions[Region::kVirtual];
  const auto& moving = models.regions[Region::kMoving];
  return {verdictOf(kModelsFollow, all[Subject::kInput].nHw2),
          verdictOf(kForgetting, models.forgettingRatio),
          controlVerdict("marks redrawn each frame fail VIRTUAL nHW2, POP or S10",
                         regionVerdicts(limits, all[Subject::kFresh], all[Subject::kInput]),
                         kNothingVirtual),
          controlVerdict("marks fixed to the screen fail them where models move by 2 px",
                         regionVerdicts(limits, moving[Subject::kFixed], moving[Subject::kInput]),
                         kNothingMoves)};
}

}  // namespace pleinair::measure
