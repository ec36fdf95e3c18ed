#pragma once

#include <chrono>
#include <memory>
#include <utility>

#include "hal/machine/machine_state.h"
#include "hal/repeated_reading.h"

namespace pleinair::hal {

/// The state of the machine, read beside everything else (thread `machine`): a sensor may take
/// long, and one on a bus that hangs does not answer at all.
using MachineMonitor = RepeatedReading<MachineState>;

inline constexpr Duration kMachineInterval = std::chrono::seconds(5);

/// Reads every kMachineInterval.
inline std::unique_ptr<MachineMonitor> monitorMachine(MachinePlaces places,
                                                      Duration interval = kMachineInterval) {
  return std::make_unique<MachineMonitor>(
      "machine", [watch = MachineWatch(std::move(places))]() mutable { return watch.read(); },
      interval);
}

}  // namespace pleinair::hal
