#include "pipeline/runtime/status/metrics/declarations.h"

namespace pleinair::runtime {
namespace {

/// Unset before the first reading, and where the machine does not tell.
template <class Read>
Readings ofMachine(const MetricMoment& moment, Read read) {
  const std::optional<hal::MachineState>& machine = moment.status.machine;
  if (!machine) return one({});
  const auto value = read(*machine);
  return value ? one(*value) : one({});
}

template <class Read>
Readings ofHottest(const MetricMoment& moment, Read read) {
  return ofMachine(moment, [&](const hal::MachineState& machine) {
    return machine.hottest ? std::optional(read(*machine.hottest)) : std::nullopt;
  });
}

StateReading clockTrust(hal::ClockTrust current) {
  return {.names = {"synchronized", "unconfirmed", "wrong"},
          .current = static_cast<std::size_t>(current)};
}

using enum MetricScope;
using enum MetricType;

}  // namespace

std::vector<Metric> machineMetrics() {
  return {
      {kMachine, "sensor", "", kText, kNoUnit, "Temperature sensor that is nearest to its limit.",
       [](Moment m) {
         return ofHottest(m, [](const hal::ThermalZone& zone) { return zone.name; });
       }},
      {kMachine, "celsius", "", kGauge, kNoUnit, "What it reads.",
       [](Moment m) {
         return ofHottest(m, [](const hal::ThermalZone& zone) { return zone.celsius; });
       }},
      {kMachine, "limit_celsius", "", kGauge, kNoUnit,
       "Temperature from which on the machine slows itself down.",
       [](Moment m) {
         return ofHottest(m, [](const hal::ThermalZone& zone) { return zone.limitCelsius; });
       }},
      {kMachine, "memory_used_bytes", "", kGauge, kNoUnit, "Memory of the program.",
       [](Moment m) {
         return ofMachine(m, [](const hal::MachineState& s) { return s.usedBytes; });
       }},
      {kMachine, "memory_available_bytes", "", kGauge, kNoUnit, "Memory that it may still take.",
       [](Moment m) {
         return ofMachine(m, [](const hal::MachineState& s) { return s.availableBytes; });
       }},
      {kMachine, "disk_free_bytes", "", kGauge, kNoUnit,
       "Free space of the disk where the program keeps its state.",
       [](Moment m) {
         return ofMachine(m, [](const hal::MachineState& s) { return s.diskFreeBytes; });
       }},
      {kMachine, "clock", "", kState, kNoUnit,
       "Whether the machine's clock was set by a time server, may be right, or cannot be: then no "
       "schedule is followed.",
       [](Moment m) {
         return ofMachine(
             m, [](const hal::MachineState& s) { return std::optional(clockTrust(s.clock)); });
       }},
      {kMachine, "clock_jumps", "", kCounter, kNoUnit,
       "Times that the machine's clock went forward or back by 2 s or more.",
       [](Moment m) {
         return ofMachine(m,
                          [](const hal::MachineState& s) { return std::optional(s.clockJumps); });
       }},
  };
}

}  // namespace pleinair::runtime
