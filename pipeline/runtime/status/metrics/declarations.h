#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/runtime/status/metrics.h"

namespace pleinair::runtime {

/// What Metric::read gives.
using Readings = std::vector<std::pair<std::string, MetricValue>>;

/// One value, of a metric without a label.
Readings one(MetricValue value);
/// One text; unknown if it is empty.
Readings textOf(const std::string& text);
/// An error's message; unknown if there is none.
Readings textOf(const std::optional<hal::Error>& error);
/// Counts by the name of the outcome.
Readings byOutcome(const std::array<std::uint64_t, kOutcomes>& ended);

// The declarations by scope.
std::vector<Metric> programMetrics();
std::vector<Metric> cameraMetrics();
std::vector<Metric> paintingMetrics();
std::vector<Metric> outputMetrics();
std::vector<Metric> frameMetrics();
std::vector<Metric> machineMetrics();

// Short names for the declarations.
using Moment = const MetricMoment&;
inline constexpr MetricUnit kNoUnit = MetricUnit::kNone;
inline constexpr MetricUnit kS = MetricUnit::kSeconds;
inline constexpr MetricUnit kMs = MetricUnit::kMilliseconds;

}  // namespace pleinair::runtime
