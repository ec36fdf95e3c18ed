#include "pipeline/runtime/status/status_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pipeline/runtime/status/metrics.h"

namespace pleinair::runtime {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<double, 4> kShares{0.5, 0.9, 0.95, 0.99};

/// One writer for each type of a reading.
template <class... Functions>
struct Overloads : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloads(Functions...) -> Overloads<Functions...>;

// ---- JSON

Json distributionJson(const DurationHistogram& durations) {
  return {{"count", durations.count()},
          {"p50_ms", hal::toMilliseconds(durations.percentile(0.5))},
          {"p90_ms", hal::toMilliseconds(durations.percentile(0.9))},
          {"p95_ms", hal::toMilliseconds(durations.percentile(0.95))},
          {"p99_ms", hal::toMilliseconds(durations.percentile(0.99))},
          {"max_ms", hal::toMilliseconds(durations.max())}};
}

/// Null if the value is unknown.
Json jsonOf(const Metric& metric, const MetricValue& value) {
  return std::visit(
      Overloads{[](std::monostate) { return Json(); },
                [](const hal::FrameFormat& format) {
                  return Json{{"layout", hal::toString(format.pixelFormat)},
                              {"width", format.size.width},
                              {"height", format.size.height}};
                },
                [&](hal::Duration duration) {
                  return Json(metric.unit == MetricUnit::kSeconds ? hal::toSeconds(duration)
                                                                  : hal::toMilliseconds(duration));
                },
                [](const StateReading& state) { return Json(state.names.at(state.current)); },
                [](const SummaryReading& summary) { return distributionJson(summary.recent); },
                [](const auto& plain) { return Json(plain); }},
      value);
}

void addJson(Json& object, const Metric& metric, const MetricMoment& moment) {
  Json all = metric.label.empty() ? Json() : Json::object();
  for (const auto& [label, value] : metric.read(moment)) {
    Json json = jsonOf(metric, value);
    if (json.is_null()) continue;
    (metric.label.empty() ? all : all[label]) = std::move(json);
  }
  if (!all.is_null()) object[jsonKey(metric)] = std::move(all);
}

Json scopeJson(MetricScope scope, const MetricMoment& moment) {
  Json json = Json::object();
  for (const Metric& metric : allMetrics()) {
    if (metric.scope == scope) addJson(json, metric, moment);
  }
  return json;
}

// ---- Prometheus

/// "name="value"", escaped as the format requires.
std::string labelText(std::string_view name, std::string_view value) {
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

/// The samples of one family, in Prometheus's text format.
class Samples {
 public:
  explicit Samples(std::string family) : family_(std::move(family)) {}

  void add(const Metric& metric, const std::string& labels, const MetricValue& value) {
    std::visit(
        Overloads{[](std::monostate) {}, [](const std::string&) {}, [](const hal::FrameFormat&) {},
                  [&](hal::Duration duration) { add(hal::toSeconds(duration), labels); },
                  [&](const StateReading& state) {
                    for (std::size_t i = 0; i < state.names.size(); ++i) {
                      const std::string name = labelText(metric.name, state.names.at(i));
                      add(i == state.current ? 1 : 0, joined(labels, name));
                    }
                  },
                  [&](const SummaryReading& summary) { add(summary, labels); },
                  [&](auto number) { add(static_cast<double>(number), labels); }},
        value);
  }
  static std::string joined(const std::string& a, const std::string& b) {
    return a.empty() || b.empty() ? a + b : a + "," + b;
  }
  const std::string& text() const { return text_; }

 private:
  void add(double value, const std::string& labels, std::string_view suffix = {}) {
    const std::string braced = labels.empty() ? "" : "{" + labels + "}";
    fmt::format_to(std::back_inserter(text_), "{}{}{} {}\n", family_, suffix, braced, value);
  }
  /// Recent quantiles; sum and count since the start.
  void add(const SummaryReading& summary, const std::string& labels) {
    for (const double share : kShares) {
      add(hal::toSeconds(summary.recent.percentile(share)),
          joined(labels, fmt::format("quantile=\"{}\"", share)));
    }
    if (!summary.count) return;
    add(hal::toSeconds(summary.sum), labels, "_sum");
    add(static_cast<double>(*summary.count), labels, "_count");
  }

  std::string family_;
  std::string text_;
};

void addSamples(Samples& samples, const Metric& metric, const MetricMoment& moment) {
  std::string output;
  if (moment.output != nullptr) output = labelText("output", moment.output->name);
  for (const auto& [label, value] : metric.read(moment)) {
    const std::string own = metric.label.empty() ? "" : labelText(metric.label, label);
    samples.add(metric, Samples::joined(output, own), value);
  }
}

std::string familyText(const Metric& metric, MetricMoment moment) {
  const std::string name = "pleinair_" + prometheusName(metric);
  Samples samples(name);
  if (metric.scope == MetricScope::kOutput) {
    for (const OutputStage::Status& output : moment.status.outputs) {
      moment.output = &output;
      addSamples(samples, metric, moment);
    }
  } else {
    addSamples(samples, metric, moment);
  }
  const std::string_view type =
      metric.type == MetricType::kState ? toString(MetricType::kGauge) : toString(metric.type);
  return fmt::format("# HELP {0} {1}\n# TYPE {0} {2}\n{3}", name, metric.help, type,
                     samples.text());
}

}  // namespace

std::string statusLine(const RuntimeStatus& status, const std::vector<std::string>& qualityNames) {
  hal::Duration p95{0};
  double shown = 0.0;
  for (const OutputStage::Status& output : status.outputs) {
    p95 = std::max(p95, output.latency.percentile(0.95));
    shown = std::max(shown, output.perSecond);
  }
  std::string text =
      fmt::format("{} · {:.1f} → {:.1f} frames/s · {:.0f} ms (p95 {:.0f}) · {}",
                  hal::toString(status.camera.state), status.camera.perSecond, shown,
                  hal::toMilliseconds(status.painting.latency), hal::toMilliseconds(p95),
                  qualityNames.at(status.painting.quality));
  if (status.ledger.dropped() > 0) text += fmt::format(" · {} dropped", status.ledger.dropped());
  return text;
}

std::string statusJson(const RuntimeStatus& status, const std::vector<std::string>& qualityNames) {
  MetricMoment moment{.status = status, .qualityNames = qualityNames};
  Json json = scopeJson(MetricScope::kProgram, moment);
  json["camera"] = scopeJson(MetricScope::kCamera, moment);
  json["painting"] = scopeJson(MetricScope::kPainting, moment);
  json["outputs"] = Json::array();
  for (const OutputStage::Status& output : status.outputs) {
    moment.output = &output;
    json["outputs"].push_back(scopeJson(MetricScope::kOutput, moment));
  }
  json["frames"] = scopeJson(MetricScope::kFrames, moment);
  json["machine"] = scopeJson(MetricScope::kMachine, moment);
  // A device's name may hold any bytes.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string statusMetrics(const RuntimeStatus& status,
                          const std::vector<std::string>& qualityNames) {
  const MetricMoment moment{.status = status, .qualityNames = qualityNames};
  std::string text;
  for (const Metric& metric : allMetrics()) {
    if (metric.type != MetricType::kText) text += familyText(metric, moment);
  }
  return text;
}

}  // namespace pleinair::runtime
