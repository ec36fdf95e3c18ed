#include "firmware_app/live/runtime_rules.h"

#include <algorithm>
#include <chrono>

#include "hal/outputs/registry.h"
#include "pipeline/engine/painter.h"

namespace pleinair::app {
namespace {

constexpr hal::Duration kUsualPeriod = std::chrono::microseconds(33'333);

/// As many frames as fall due within the maximum latency, and two more.
std::size_t queueCapacity(hal::Duration maxLatency, hal::Duration period) {
  constexpr std::int64_t kMaxWaiting = 64;
  return static_cast<std::size_t>(
      std::clamp<std::int64_t>(maxLatency / period + 2, 3, kMaxWaiting));
}

}  // namespace

std::vector<std::string> qualityNames() {
  std::vector<std::string> names;
  for (const QualityLevel& level : qualityLevels()) names.push_back(level.name);
  return names;
}

runtime::PaintStageOptions paintRules(const RuntimeSettings& settings,
                                      const hal::StreamFormat& stream) {
  const std::vector<std::string> names = qualityNames();
  const auto pinned = std::ranges::find(names, settings.quality);
  runtime::PaintStageOptions options{.governor = {.levels = names.size(), .pinned = {}},
                                     .latency = {},
                                     .framePeriod = stream.framePeriod};
  if (pinned != names.end()) {
    options.governor.pinned = static_cast<std::size_t>(pinned - names.begin());
  }
  options.latency.configured = hal::fromMilliseconds(settings.latencyMs);
  options.latency.maximum = hal::fromMilliseconds(settings.maxLatencyMs);
  if (settings.rate > 0.0) {
    const hal::Duration wanted = hal::fromMilliseconds(1000.0 / settings.rate);
    options.framePeriod = std::max(wanted, stream.framePeriod.value_or(wanted));
  }
  return options;
}

runtime::HeatRules heatRules(const RuntimeSettings& settings) {
  const std::vector<std::string> names = qualityNames();
  const bool isFixed = std::ranges::find(names, settings.quality) != names.end();
  return {.levels = isFixed ? 1 : names.size(), .marginKelvin = settings.heatMargin};
}

runtime::OutputStageOptions outputRules(const std::string& target, const OutputOpener& open,
                                        const RuntimeSettings& settings,
                                        const hal::StreamFormat& stream) {
  const hal::OutputTraits& traits = hal::orThrow(hal::outputKindOf(target))->traits;
  const hal::Duration period = stream.framePeriod.value_or(kUsualPeriod);
  const hal::Duration maxLatency = hal::fromMilliseconds(settings.maxLatencyMs);
  constexpr hal::Duration kMaxTolerance = std::chrono::milliseconds(8);
  runtime::OutputStageOptions options{
      .name = target,
      .rules = {.isPaced = traits.isPaced, .tolerance = std::min(period / 4, kMaxTolerance)},
      .waiting = queueCapacity(maxLatency, period),
      .limit = {},
      .reopen = {},
      .request = {}};
  if (traits.reopens) {
    options.reopen = [target, open] { return open(target); };
  }
  return options;
}

}  // namespace pleinair::app
