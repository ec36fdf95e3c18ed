#include "firmware_app/live/status/machine_health.h"

#include <fmt/format.h>

namespace pleinair::app {

HeatAdvice HeatWatch::update(const hal::MachineState& machine, std::size_t level,
                             hal::TimePoint now) {
  const bool wasHot = guard_.isHot();
  const std::optional<hal::ThermalZone>& zone = machine.hottest;
  guard_.update(zone ? std::optional(zone->marginCelsius()) : std::nullopt, level, now);
  HeatAdvice advice{.best = guard_.best(), .notice = {}, .isGood = !guard_.isHot()};
  if (guard_.isHot() == wasHot) return advice;
  if (guard_.isHot()) {
    advice.notice = fmt::format(
        "{} is at {:.0f} °C, and the machine slows itself down from {:.0f} °C on: {}", zone->name,
        zone->celsius, zone->limitCelsius,
        levels_ > 1 ? "quality is lowered until it has cooled" : "but the quality is a fixed one");
  } else {
    advice.notice = "the machine has cooled: quality is no longer lowered for it";
  }
  return advice;
}

std::optional<HeatAdvice> MachineHealth::update(std::size_t level, hal::TimePoint now) {
  const auto reading = monitor_->latest();
  if (!reading || reading->number == seen_) return std::nullopt;
  seen_ = reading->number;
  return heat_.update(reading->value, level, now);
}

std::optional<hal::MachineState> MachineHealth::state() const {
  const auto reading = monitor_->latest();
  return reading ? std::optional(reading->value) : std::nullopt;
}

}  // namespace pleinair::app
