#pragma once

#include <string>
#include <vector>

#include "pipeline/runtime/status/runtime_status.h"

namespace pleinair::runtime {

/// One line for a terminal: "streaming · 30.0 → 29.8 frames/s · 120 ms (p95 121) · full · 3
/// dropped". `qualityNames`: names of the levels, best first.
std::string statusLine(const RuntimeStatus& status, const std::vector<std::string>& qualityNames);

/// All metrics as a JSON object; docs/operation.md lists its members, whose names carry the unit.
std::string statusJson(const RuntimeStatus& status, const std::vector<std::string>& qualityNames);

/// All metrics but texts in Prometheus's text format 0.0.4; durations in seconds, names begin with
/// "pleinair_".
std::string statusMetrics(const RuntimeStatus& status,
                          const std::vector<std::string>& qualityNames);

}  // namespace pleinair::runtime
