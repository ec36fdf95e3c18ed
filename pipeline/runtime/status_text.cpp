#include "pipeline/runtime/status_text.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace pleinair::runtime {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<double, 4> kShares{0.5, 0.9, 0.95, 0.99};

const std::string& qualityName(const RuntimeStatus& status, const std::vector<std::string>& names) {
  return names.at(status.painting.quality);
}

Json toJson(const DurationHistogram& durations) {
  return {{"count", durations.count()},
          {"p50_ms", hal::toMilliseconds(durations.percentile(0.5))},
          {"p90_ms", hal::toMilliseconds(durations.percentile(0.9))},
          {"p95_ms", hal::toMilliseconds(durations.percentile(0.95))},
          {"p99_ms", hal::toMilliseconds(durations.percentile(0.99))},
          {"max_ms", hal::toMilliseconds(durations.max())}};
}

Json toJson(const std::array<std::uint64_t, kOutcomes>& ended) {
  Json json = Json::object();
  for (const Outcome outcome : allOutcomes()) {
    json[std::string(nameOf(outcome))] = ended.at(static_cast<std::size_t>(outcome));
  }
  return json;
}

Json toJson(const hal::FrameFormat& format) {
  return {{"layout", hal::toString(format.pixelFormat)},
          {"width", format.size.width},
          {"height", format.size.height}};
}

Json cameraJson(const CaptureStage::Status& camera) {
  Json json{{"state", hal::toString(camera.state)},
            {"reason", camera.reason},
            {"frames_per_second", camera.perSecond},
            {"delivery_p50_ms", hal::toMilliseconds(camera.delay)},
            {"opens", camera.opens},
            {"losses", camera.losses},
            {"stalls", camera.stalls}};
  if (!camera.lastLoss.empty()) json["last_loss"] = camera.lastLoss;
  if (camera.camera) {
    json["backend"] = camera.camera->backend;
    json["id"] = camera.camera->id;
    json["description"] = camera.camera->description;
  }
  if (camera.format) json["format"] = toJson(camera.format->frame);
  return json;
}

Json paintingJson(const RuntimeStatus& status, const std::vector<std::string>& names) {
  const PaintStage::Status& painting = status.painting;
  Json json{{"frames_per_second", painting.perSecond},
            {"painted", painting.painted},
            {"load", painting.load},
            {"quality", qualityName(status, names)},
            {"quality_lowered", painting.qualityLowered},
            {"quality_raised", painting.qualityRaised},
            {"latency_ms", hal::toMilliseconds(painting.latency)},
            {"latency_configured_ms", hal::toMilliseconds(painting.configuredLatency)},
            {"latency_raised", painting.latencyRaised},
            {"latency_lowered", painting.latencyLowered},
            {"failures", painting.failures},
            {"context_losses", painting.contextLosses}};
  if (painting.failure) json["last_failure"] = painting.failure->message();
  for (const PaintStage::Stage& stage : painting.stages) {
    json["stages"][std::string(stage.name)] = toJson(stage.recent);
  }
  return json;
}

Json outputJson(const OutputStage::Status& output) {
  Json json{{"name", output.name},
            {"format", toJson(output.format)},
            {"state", output.isFinal    ? "failed"
                      : output.isFailed ? "reopening"
                                        : "taking"},
            {"frames_per_second", output.perSecond},
            {"latency", toJson(output.latency)},
            {"writing", toJson(output.writing)},
            {"pictures", output.submitted},
            {"repeats", output.repeats},
            {"waiting", output.waiting},
            {"ended", toJson(output.ended)},
            {"failures", output.failures}};
  if (output.failure) json["last_failure"] = output.failure->message();
  return json;
}

/// Prometheus's text: a family's help and type, then its samples.
class Metrics {
 public:
  void family(std::string_view name, std::string_view type, std::string_view help) {
    name_ = name;
    fmt::format_to(std::back_inserter(text_), "# HELP pleinair_{0} {1}\n# TYPE pleinair_{0} {2}\n",
                   name, help, type);
  }
  void sample(double value, const std::string& labels = {}, std::string_view suffix = {}) {
    const std::string braced = labels.empty() ? "" : "{" + labels + "}";
    fmt::format_to(std::back_inserter(text_), "pleinair_{}{}{} {}\n", name_, suffix, braced, value);
  }
  void single(std::string_view name, std::string_view type, std::string_view help, double value) {
    family(name, type, help);
    sample(value);
  }
  /// Quantiles of late, sum and count of all.
  void summary(const DurationHistogram& recent, std::uint64_t count, hal::Duration sum,
               const std::string& labels) {
    for (const double share : kShares) {
      sample(hal::toSeconds(recent.percentile(share)), fmt::format("{},quantile=\"{}\"", labels, share));
    }
    sample(hal::toSeconds(sum), labels, "_sum");
    sample(static_cast<double>(count), labels, "_count");
  }
  const std::string& text() const { return text_; }

 private:
  std::string name_;
  std::string text_;
};

/// A label with what its value's syntax wants escaped.
std::string label(std::string_view name, std::string_view value) {
  std::string escaped;
  for (const char c : value) {
    if (c == '\\' || c == '"') escaped += '\\';
    if (c == '\n') {
      escaped += "\\n";
    } else {
      escaped += c;
    }
  }
  return fmt::format("{}=\"{}\"", name, escaped);
}

double number(std::uint64_t value) {
  return static_cast<double>(value);
}

void addFrames(Metrics& metrics, const RuntimeStatus& status) {
  metrics.single("frames_captured_total", "counter", "Frames that the camera made.",
                 number(status.ledger.captured));
  metrics.single("frames_in_flight", "gauge", "Frames that have not ended yet.",
                 number(status.ledger.inFlight));
  metrics.family("frames_total", "counter", "Frames by how they ended; each ends once.");
  for (const Outcome outcome : allOutcomes()) {
    metrics.sample(number(status.ledger.of(outcome)), label("outcome", nameOf(outcome)));
  }
}

void addCamera(Metrics& metrics, const CaptureStage::Status& camera) {
  metrics.single("camera_streaming", "gauge", "1 while frames come.",
                 camera.state == hal::CameraState::kStreaming ? 1 : 0);
  metrics.single("camera_frames_per_second", "gauge", "Frames that arrived in the last second.",
                 camera.perSecond);
  metrics.single("camera_opens_total", "counter", "How often a camera was opened.",
                 number(camera.opens));
  metrics.single("camera_losses_total", "counter", "How often it was lost.", number(camera.losses));
  metrics.single("camera_stalls_total", "counter", "How often it fell silent.",
                 number(camera.stalls));
}

void addPainting(Metrics& metrics, const RuntimeStatus& status,
                 const std::vector<std::string>& names) {
  const PaintStage::Status& painting = status.painting;
  metrics.single("painted_total", "counter", "Pictures painted.", number(painting.painted));
  metrics.single("painted_per_second", "gauge", "Pictures painted in the last second.",
                 painting.perSecond);
  metrics.single("load", "gauge", "Share of its budget that the last frame took.", painting.load);
  metrics.family("quality_level", "gauge", "1 for the level of quality in force.");
  for (std::size_t i = 0; i < names.size(); ++i) {
    metrics.sample(i == painting.quality ? 1 : 0, label("level", names.at(i)));
  }
  metrics.single("quality_lowered_total", "counter", "How often quality was lowered.",
                 number(painting.qualityLowered));
  metrics.single("quality_raised_total", "counter", "How often quality was raised.",
                 number(painting.qualityRaised));
  metrics.single("latency_target_seconds", "gauge", "When after its capture a frame is due.",
                 hal::toSeconds(painting.latency));
  metrics.single("latency_raised_total", "counter", "How often the target had to be raised.",
                 number(painting.latencyRaised));
  metrics.single("latency_lowered_total", "counter", "How often it went back.",
                 number(painting.latencyLowered));
  metrics.single("context_losses_total", "counter", "How often the GPU was lost.",
                 number(painting.contextLosses));
  metrics.family("stage_seconds", "summary", "What each stage takes of a frame; lately.");
  for (const PaintStage::Stage& stage : painting.stages) {
    metrics.summary(stage.recent, stage.count, stage.sum, label("stage", stage.name));
  }
}

void addOutputs(Metrics& metrics, const std::vector<OutputStage::Status>& outputs) {
  metrics.family("output_pictures_total", "counter", "Pictures by output and how they ended.");
  for (const auto& output : outputs) {
    for (const Outcome outcome : allOutcomes()) {
      const std::uint64_t ended = output.ended.at(static_cast<std::size_t>(outcome));
      if (ended == 0 && !isShown(outcome)) continue;
      metrics.sample(number(ended),
                     label("output", output.name) + "," + label("outcome", nameOf(outcome)));
    }
  }
  metrics.family("output_per_second", "gauge", "Pictures that an output took in the last second.");
  for (const auto& output : outputs) {
    metrics.sample(output.perSecond, label("output", output.name));
  }
  metrics.family("output_up", "gauge", "0 while an output takes no pictures.");
  for (const auto& output : outputs) {
    metrics.sample(output.isFailed ? 0 : 1, label("output", output.name));
  }
  metrics.family("capture_to_present_seconds", "summary", "From capture to output; lately.");
  for (const auto& output : outputs) {
    metrics.summary(output.latency, output.presented, output.latencySum,
                    label("output", output.name));
  }
}

}  // namespace

std::string statusLine(const RuntimeStatus& status, const std::vector<std::string>& qualityNames) {
  hal::Duration p95{0};
  double shown = 0.0;
  for (const OutputStage::Status& output : status.outputs) {
    p95 = std::max(p95, output.latency.percentile(0.95));
    shown = std::max(shown, output.perSecond);
  }
  std::string text = fmt::format("{} · {:.1f} → {:.1f} frames/s · {:.0f} ms (p95 {:.0f}) · {}",
                                 hal::toString(status.camera.state), status.camera.perSecond, shown,
                                 hal::toMilliseconds(status.painting.latency), hal::toMilliseconds(p95),
                                 qualityName(status, qualityNames));
  if (status.ledger.dropped() > 0) text += fmt::format(" · {} dropped", status.ledger.dropped());
  return text;
}

std::string statusJson(const RuntimeStatus& status, const std::vector<std::string>& qualityNames) {
  Json json{{"uptime_s", hal::toSeconds(status.uptime)},
            {"healthy", status.isHealthy()},
            {"camera", cameraJson(status.camera)},
            {"painting", paintingJson(status, qualityNames)},
            {"outputs", Json::array()},
            {"frames",
             {{"captured", status.ledger.captured},
              {"in_flight", status.ledger.inFlight},
              {"ended", toJson(status.ledger.ended)}}}};
  for (const OutputStage::Status& output : status.outputs) {
    json["outputs"].push_back(outputJson(output));
  }
  // A device's name may hold anything.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string statusMetrics(const RuntimeStatus& status,
                          const std::vector<std::string>& qualityNames) {
  Metrics metrics;
  metrics.single("uptime_seconds", "gauge", "Since the start.", hal::toSeconds(status.uptime));
  metrics.single("healthy", "gauge", "1 while pictures come out.", status.isHealthy() ? 1 : 0);
  addFrames(metrics, status);
  addCamera(metrics, status.camera);
  addPainting(metrics, status, qualityNames);
  addOutputs(metrics, status.outputs);
  return metrics.text();
}

}  // namespace pleinair::runtime
