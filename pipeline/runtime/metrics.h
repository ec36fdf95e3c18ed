#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "hal/pixel_format.h"
#include "pipeline/runtime/runtime_status.h"

namespace pleinair::runtime {

enum class MetricType {
  kText,     ///< texts and formats: only in JSON
  kGauge,    ///< a number or a switch that goes up and down
  kCounter,  ///< only grows
  kState,    ///< one of several names; in Prometheus' format a sample for each, 1 for the current
  kSummary,  ///< durations: a distribution of the last 30 to 60 s; sum and count since the start
};

/// The unit in JSON, whose name carries it ("_s", "_ms"). Prometheus' format has seconds only.
enum class MetricUnit { kNone, kSeconds, kMilliseconds };

/// The part of the live chain that a metric belongs to, in the order in which they are written.
enum class MetricScope { kProgram, kCamera, kPainting, kOutput, kFrames };

/// The moment that metrics are read from.
struct MetricMoment {
  const RuntimeStatus& status;
  const std::vector<std::string>& qualityNames;  ///< of the levels, the best first
  const OutputStage::Status* output = nullptr;   ///< for metrics of kOutput: which one
};

struct StateReading {
  std::vector<std::string> names;
  std::size_t current = 0;
};
struct SummaryReading {
  DurationHistogram recent;
  /// The number of durations since the start; unset where only the recent ones are known.
  std::optional<std::uint64_t> count;
  hal::Duration sum{0};
};
/// monostate: not known at this moment; the metric is left out.
using MetricValue = std::variant<std::monostate, std::string, hal::FrameFormat, bool, std::uint64_t,
                                 double, hal::Duration, StateReading, SummaryReading>;

/// One figure that the running program reports. Its declaration gives the member of /status, the
/// family of /metrics with its help, and the row in docs/operation.md. Names follow from the
/// declaration: "camera", "losses", a counter are `camera.losses` and `camera_losses_total`.
struct Metric {
  MetricScope scope = MetricScope::kProgram;
  std::string_view name;   ///< without scope and unit: "losses"
  std::string_view label;  ///< what distinguishes several values: "outcome"; empty: there is one
  MetricType type = MetricType::kGauge;
  MetricUnit unit = MetricUnit::kNone;
  std::string_view help;  ///< one sentence
  /// The values at that moment, by the label's value; one, by an empty one, where there is no
  /// label. Any thread.
  std::vector<std::pair<std::string, MetricValue>> (*read)(const MetricMoment&) = nullptr;
  /// The family in /metrics that this one took the place of, for whoever has dashboards.
  std::string_view formerly;
};

/// All metrics, grouped by scope.
const std::vector<Metric>& allMetrics();

/// Its key in the scope's JSON object: "latency_ms".
std::string jsonKey(const Metric& metric);
/// Where it is in /status: "camera.losses", "outputs[].state".
std::string jsonPath(const Metric& metric);
/// Its family in /metrics, without "pleinair_": "camera_losses_total"; empty for kText.
std::string prometheusName(const Metric& metric);
/// "gauge", "counter", "summary" …
std::string_view toString(MetricType type);

}  // namespace pleinair::runtime
