#include "pipeline/runtime/status/metrics.h"

#include <array>

#include "pipeline/runtime/status/metrics/declarations.h"

namespace pleinair::runtime {

namespace {

using enum MetricScope;
using enum MetricType;

/// The prefix of a scope's names, in JSON and in Prometheus' format.
struct ScopeNames {
  std::string_view json;
  std::string_view prometheus;
};

ScopeNames namesOf(MetricScope scope) {
  switch (scope) {
    case kProgram:
      return {"", ""};
    case kCamera:
      return {"camera.", "camera_"};
    case kPainting:
      return {"painting.", "painting_"};
    case kOutput:
      return {"outputs[].", "output_"};
    case kFrames:
      return {"frames.", "frames_"};
    case kMachine:
      return {"machine.", "machine_"};
  }
  return {};
}

}  // namespace

const std::vector<Metric>& allMetrics() {
  static const std::vector<Metric> kMetrics = [] {
    std::vector<Metric> all;
    for (const auto& part : {programMetrics(), cameraMetrics(), paintingMetrics(), outputMetrics(),
                             frameMetrics(), machineMetrics()}) {
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }();
  return kMetrics;
}

std::string jsonKey(const Metric& metric) {
  std::string key(metric.name);
  if (metric.type == kSummary) return key;  // its members carry the unit
  if (metric.unit == kS) key += "_s";
  if (metric.unit == kMs) key += "_ms";
  return key;
}

std::string jsonPath(const Metric& metric) {
  return std::string(namesOf(metric.scope).json) + jsonKey(metric);
}

std::string prometheusName(const Metric& metric) {
  if (metric.type == kText) return {};
  std::string name = std::string(namesOf(metric.scope).prometheus) + std::string(metric.name);
  if (metric.unit != kNoUnit) name += "_seconds";
  if (metric.type == kCounter) name += "_total";
  return name;
}

std::string_view toString(MetricType type) {
  constexpr std::array<std::string_view, 5> kNames{"text", "gauge", "counter", "state", "summary"};
  return kNames.at(static_cast<std::size_t>(type));
}

}  // namespace pleinair::runtime
