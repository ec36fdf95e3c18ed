#include <nlohmann/json.hpp>

#include "pipeline/measure/measurement_report.h"

namespace pleinair::measure {
namespace {

using Json = nlohmann::ordered_json;

Json orNull(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json jsonOf(const Measures& measures) {
  Json json = Json::object();
  for (const MeasureColumn& column : measureColumns()) {
    json[column.key] = orNull(measures.*column.value);
  }
  return json;
}

const char* wordOf(Verdict::State state) {
  switch (state) {
    case Verdict::State::kPassed:
      return "pass";
    case Verdict::State::kFailed:
      return "fail";
    case Verdict::State::kNotMeasured:
      break;
  }
  return "not measured";
}

Json jsonOf(const std::vector<Verdict>& verdicts) {
  Json list = Json::array();
  for (const Verdict& verdict : verdicts) {
    const bool isMeasured = verdict.state != Verdict::State::kNotMeasured;
    const Verdict::Comparison comparison = verdict.comparison.value_or(Verdict::Comparison());
    list.push_back(
        {{"what", verdict.what},
         {"verdict", wordOf(verdict.state)},
         {"found", verdict.found},
         {"value", orNull(comparison.value)},
         {"limit", orNull(comparison.limit)},
         {"sense", !verdict.comparison       ? Json(nullptr)
                   : comparison.isUpperLimit ? Json("at most")
                                             : Json("at least")},
         {"passed", isMeasured ? Json(verdict.state == Verdict::State::kPassed) : Json(nullptr)}});
  }
  return list;
}

Json jsonOf(const std::optional<Drift>& drift) {
  if (!drift) return nullptr;
  return {{"median_px", drift->median}, {"p95_px", drift->percentile95}, {"rms_px", drift->rms}};
}

Json jsonOf(const std::optional<AnchorSummary>& anchors) {
  if (!anchors) return nullptr;
  return {
      {"frames", anchors->frames},
      {"alive", anchors->alive},
      {"births_a_frame", anchors->births},
      {"deaths_a_frame", anchors->deaths},
      {"inner_births_a_frame", anchors->innerBirths},
      {"inner_deaths_a_frame", anchors->innerDeaths},
      {"inner_turnover_percent", anchors->innerTurnoverPercent},
      {"moved_a_frame", anchors->moved},
      {"half_life_frames", orNull(anchors->halfLifeFrames)},
      {"half_life_over_frames", anchors->halfLifeFrames ? Json(nullptr) : Json(anchors->frames)},
      {"drift", jsonOf(anchors->drift)},
      {"drift_over_10_frames", jsonOf(anchors->longDrift)},
      {"anchors_per_cell",
       {{"mean", anchors->perCell},
        {"spread", anchors->spreadPerCell},
        {"empty_percent", anchors->emptyCellsPercent}}}};
}

Json jsonOf(const TextureDifference& difference) {
  return {{"cooccurrence_error", difference.cooccurrenceError},
          {"spectrum_error", difference.spectrumError},
          {"frequency_ratio", difference.frequencyRatio}};
}

Json jsonOf(const std::optional<Flatness>& flatness) {
  if (!flatness) return nullptr;
  return {{"scale", flatness->scale},
          {"painting", jsonOf(flatness->painting)},
          {"input", jsonOf(flatness->input)}};
}

Json jsonOf(const MoverSummary& movers) {
  return {{"covered_percent", movers.coveredPercent},
          {"still_percent", orNull(movers.stillPercent)},
          {"return_levels", orNull(movers.returnLevels)},
          {"follow", orNull(movers.follow)},
          {"ghost", orNull(movers.ghost)},
          {"lost_percent", orNull(movers.lostPercent)},
          {"remains_percent", orNull(movers.remainsPercent)}};
}

Json jsonOf(const MoverMotionSummary& along) {
  return {{"mover_nhw2", orNull(along.nHw2)},
          {"mover_pop_percent", orNull(along.popPercent)},
          {"seam_pop_percent", orNull(along.seamPopPercent)},
          {"mover_pop_smoothed_percent", orNull(along.smoothPopPercent)},
          {"seam_pop_smoothed_percent", orNull(along.smoothSeamPopPercent)}};
}

Json jsonOf(const RegionSummary& region) {
  return {{"ew2", orNull(region.ew2)},
          {"nhw2", orNull(region.nHw2)},
          {"pop_percent", orNull(region.popPercent)},
          {"s10_percent", orNull(region.s10Percent)}};
}

template <class Value>
Json jsonOf(const PerSubject<Value>& values) {
  return {{"painting", jsonOf(values[Subject::kPainting])},
          {"input", jsonOf(values[Subject::kInput])},
          {"redrawn", jsonOf(values[Subject::kFresh])},
          {"fixed", jsonOf(values[Subject::kFixed])}};
}

Json jsonOf(const std::optional<MoverReport>& movers) {
  if (!movers) return nullptr;
  return {{"masks", movers->areMasksTrue ? "true" : "found"},
          {"painting", jsonOf(movers->painting)},
          {"averaging", jsonOf(movers->averaging)},
          {"along_motion", jsonOf(movers->alongMotion)},
          {"displaced_still_percent", orNull(movers->displacedStillPercent)}};
}

Json jsonOf(const std::optional<ModelAnchorSummary>& anchors) {
  if (!anchors) return nullptr;
  return {{"frames", anchors->frames},
          {"anchors", anchors->anchors},
          {"births_a_frame", anchors->births},
          {"deaths_a_frame", anchors->deaths},
          {"turnover_percent", anchors->turnoverPercent},
          {"resized_percent", anchors->resizedPercent},
          {"slip", jsonOf(anchors->slip)},
          {"slip_over_10_frames", jsonOf(anchors->longSlip)}};
}

Json jsonOf(const std::optional<ModelReport>& models) {
  if (!models) return nullptr;
  Json json = Json::object();
  const auto add = [&](const char* name, Region region) {
    json[name] = jsonOf(models->regions[region]);
    json[name]["covered_percent"] = models->regions[region][Subject::kPainting].coveredPercent;
  };
  add("real", Region::kReal);
  add("virtual", Region::kVirtual);
  add("seam", Region::kSeam);
  add("virtual_moving", Region::kMoving);
  json["forgetting_ew2_ratio"] = orNull(models->forgettingRatio);
  json["anchors"] = jsonOf(models->anchors);
  return json;
}

Json labelsOf(const Report& report) {
  if (!report.labels && !report.labelFlipsOnStillPercent) return nullptr;
  Json json{{"still_flips_percent", orNull(report.labelFlipsOnStillPercent)}};
  if (!report.labels) return json;
  const LabelSummary& labels = *report.labels;
  json["iou_mean"] = orNull(labels.meanIou);
  json["iou_worst"] = orNull(labels.worstIou);
  json["iou_worst_frame"] = labels.worstIou ? Json(labels.worstFrame) : Json(nullptr);
  json["iou_displaced_masks"] = orNull(labels.displacedIou);
  json["flips_percent"] = orNull(labels.flipsPercent);
  json["detections"] = Json::array();
  for (const Detection& each : labels.detections) {
    json["detections"].push_back({{"frame", each.frame},
                                  {"frames", each.frames},
                                  {"ms", 1000 * hal::toSeconds(each.time)},
                                  {"found", each.isFound}});
  }
  return json;
}

Json jsonOf(const FrameValues& values) {
  Json json{{"frame", values.frame},
            {"painting", jsonOf(values.painting)},
            {"input", jsonOf(values.input)}};
  if (values.labelIou) json["label_iou"] = *values.labelIou;
  if (values.anchors) {
    json["anchors"] = {{"alive", values.anchors->alive},
                       {"births", values.anchors->births},
                       {"deaths", values.anchors->deaths},
                       {"inner_births", values.anchors->innerBirths},
                       {"inner_deaths", values.anchors->innerDeaths},
                       {"drift", jsonOf(values.anchors->drift)}};
  }
  return json;
}

}  // namespace

std::string reportJson(const Report& report) {
  Json json{{"style", report.style},
            {"settings", report.settings},
            {"input", report.input},
            {"motion", report.motion},
            {"size", {report.size.width, report.size.height}},
            {"settled_frames", report.settled},
            {"frames", report.frames},
            {"still_frames", report.stillFrames},
            {"still_noise_levels", report.stillNoise},
            {"measures", jsonOf(report.measures)},
            {"controls_valid", report.areControlsValid()},
            {"controls", jsonOf(report.controls)},
            {"gates_passed", report.gates.empty() ? Json(nullptr) : Json(report.areGatesPassed())},
            {"gates", jsonOf(report.gates)},
            {"inside", jsonOf(report.inside)},
            {"inside_still", jsonOf(report.insideStill)},
            {"flatness", jsonOf(report.flatness)},
            {"movers", jsonOf(report.movers)},
            {"labels", labelsOf(report)},
            {"models", jsonOf(report.models)},
            {"left_out", report.leftOut},
            {"notes", report.notices},
            {"over_time", Json::array()}};
  for (const FrameValues& values : report.overTime) json["over_time"].push_back(jsonOf(values));
  // File names may contain any bytes.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace pleinair::measure
