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
#include "pipeline/runtime/status/runtime_status.h"

namespace pleinair::runtime {

enum class MetricType {
  kText,     ///< texts and formats: only in JSON
  kGauge,    ///< a number or a switch that goes up and down
  kCounter,  ///< a count since the start
  kState,    ///< one of several names; in Prometheus' format a sample for each, 1 for the current
  kSummary,  ///< durations: a distribution of the last 30 to 60 s; sum and count since the start
};

/// The unit in JSON, whose name carries it ("_s", "_ms"). Prometheus' format has seconds only.
enum class MetricUnit { kNone, kSeconds, kMilliseconds };

/// The part of the live pipeline that a metric belongs to, in the order of the output.
enum class MetricScope { kProgram, kCamera, kPainting, kOutput, kFrames, kMachine };

/// The state that metrics are read from.
struct MetricMoment {
  const RuntimeStatus& status;
  const std::vector<std::string>& qualityNames;  ///< names of the levels, best first
  const OutputStage::Status* output = nullptr;   ///< the output, for metrics of kOutput
};

struct StateReading {
  std::vector<std::string> names;
  std::size_t current = 0;
};
struct SummaryReading {
  DurationHistogram recent;
  /// Number of durations since the start; unset if only the recent ones are known.
  std::optional<std::uint64_t> count;
  hal::Duration sum{0};
};
/// monostate: unknown at this moment; the metric is left out.
using MetricValue = std::variant<std::monostate, std::string, hal::FrameFormat, bool, std::uint64_t,
                                 double, hal::Duration, StateReading, SummaryReading>;

/// A metric of the running program. This declaration yields its member in /status, its family in
/// /metrics with help, and its row in docs/operation.md. The names follow from it: the counter
/// "losses" of kCamera is `camera.losses` and `camera_losses_total`.
struct Metric {
  MetricScope scope = MetricScope::kProgram;
  std::string_view name;  ///< without scope and unit: "losses"
  std::string_view
      label;  ///< the label that tells several values apart: "outcome"; empty: one value
  MetricType type = MetricType::kGauge;
  MetricUnit unit = MetricUnit::kNone;
  std::string_view help;  ///< one sentence
  /// Reads the values, each with its label's value; without a label, one value with an empty one.
  /// Any thread.
  std::vector<std::pair<std::string, MetricValue>> (*read)(const MetricMoment&) = nullptr;
  /// The family of /metrics that this one replaces, for those who have dashboards.
  std::string_view formerly;
};

/// All metrics, grouped by scope.
const std::vector<Metric>& allMetrics();

/// Its key in the scope's JSON object: "latency_ms".
std::string jsonKey(const Metric& metric);
/// Its path in /status: "camera.losses", "outputs[].state".
std::string jsonPath(const Metric& metric);
/// Its family in /metrics, without "pleinair_": "camera_losses_total"; empty for kText.
std::string prometheusName(const Metric& metric);
/// "gauge", "counter", "summary" …
std::string_view toString(MetricType type);

}  // namespace pleinair::runtime
