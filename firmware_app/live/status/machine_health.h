#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "hal/clock.h"
#include "hal/machine/machine_monitor.h"
#include "pipeline/runtime/control/heat_guard.h"

namespace pleinair::app {

/// What heat asks of the painting, and what is told of it.
struct HeatAdvice {
  /// The best quality level that is permitted (runtime::PaintStage::limitQuality()).
  std::size_t best = 0;
  std::string notice;  ///< for the log, once when it begins and once when it ends; else empty
  bool isGood = false;
};

/// Turns readings of the machine into advice. One thread.
class HeatWatch {
 public:
  explicit HeatWatch(runtime::HeatRules rules) : levels_(rules.levels), guard_(rules) {}

  /// To be called with each reading. `level`: the quality level in force.
  HeatAdvice update(const hal::MachineState& machine, std::size_t level, hal::TimePoint now);

 private:
  std::size_t levels_;
  runtime::HeatGuard guard_;
};

/// The machine's state while painting goes on, read beside it, and what its heat asks for.
class MachineHealth {
 public:
  MachineHealth(hal::MachinePlaces places, runtime::HeatRules rules)
      : monitor_(hal::monitorMachine(std::move(places))), heat_(rules) {}

  /// As HeatWatch::update(); nothing where there is no new reading. One thread.
  std::optional<HeatAdvice> update(std::size_t level, hal::TimePoint now);
  /// Nothing before the first reading. Any thread.
  std::optional<hal::MachineState> state() const;

 private:
  std::unique_ptr<hal::MachineMonitor> monitor_;
  HeatWatch heat_;
  std::uint64_t seen_ = 0;  ///< number of the last reading
};

}  // namespace pleinair::app
