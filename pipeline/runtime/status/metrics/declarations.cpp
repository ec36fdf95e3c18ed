#include "pipeline/runtime/status/metrics/declarations.h"

namespace pleinair::runtime {

Readings one(MetricValue value) {
  Readings readings;
  readings.emplace_back(std::string(), std::move(value));
  return readings;
}

Readings textOf(const std::string& text) {
  return text.empty() ? one({}) : one(text);
}

Readings textOf(const std::optional<hal::Error>& error) {
  return error ? one(error->message()) : one({});
}

Readings byOutcome(const std::array<std::uint64_t, kOutcomes>& ended) {
  Readings readings;
  for (const Outcome outcome : allOutcomes()) {
    readings.emplace_back(nameOf(outcome), ended.at(static_cast<std::size_t>(outcome)));
  }
  return readings;
}

}  // namespace pleinair::runtime
