#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "hal/clock.h"

namespace pleinair::hal {

/// A sensor of the kernel's thermal framework.
struct ThermalZone {
  std::string name;  ///< "cpu-thermal"
  double celsius = 0.0;
  /// From here on the machine slows itself down: the lowest trip point that does (passive, hot),
  /// else 15 K below the one that switches off, and at most kUsualLimit where there is none that
  /// slows down, since firmware then may.
  double limitCelsius = 0.0;
  static constexpr double kUsualLimit = 80.0;

  double marginCelsius() const { return limitCelsius - celsius; }
};

/// What is known of the machine's clock.
enum class ClockTrust {
  kSynchronized,  ///< with a time server
  kUnconfirmed,   ///< it may be right: of a battery, or set by hand
  kWrong,         ///< it cannot be right (isPlausible())
};

/// The state of the machine that a kiosk depends on. Unset: not known.
struct MachineState {
  std::optional<ThermalZone> hottest;           ///< the one that is nearest to its limit
  std::optional<std::uint64_t> usedBytes;       ///< memory of this process
  std::optional<std::uint64_t> availableBytes;  ///< memory that it may still take
  std::optional<std::uint64_t> diskFreeBytes;   ///< where it keeps its state
  ClockTrust clock = ClockTrust::kUnconfirmed;
  std::uint64_t clockJumps = 0;  ///< times that the clock went forward or back by 2 s or more
};

/// Files of the kernel; tests replace them.
struct MachinePlaces {
  std::filesystem::path thermal = "/sys/class/thermal";
  std::filesystem::path process = "/proc/self";
  std::filesystem::path memory = "/proc/meminfo";
  std::filesystem::path cgroups = "/sys/fs/cgroup";
  std::filesystem::path synchronized = "/run/systemd/timesync/synchronized";
  std::filesystem::path state;  ///< empty: none
};

/// Reads the state of the machine. A read takes up to some milliseconds, since sensors are asked.
/// One thread.
class MachineWatch {
 public:
  explicit MachineWatch(MachinePlaces places) : places_(std::move(places)) {}

  /// `time`: by the machine's clock; `sinceBoot`: by one that nobody sets.
  MachineState read(std::chrono::system_clock::time_point time, Duration sinceBoot);
  /// With the machine's clocks.
  MachineState read();

 private:
  std::optional<ThermalZone> hottest() const;
  std::optional<std::uint64_t> availableBytes() const;
  void followClock(std::chrono::system_clock::time_point time, Duration sinceBoot);

  MachinePlaces places_;
  std::optional<Duration> bootTime_;  ///< by the machine's clock
  std::uint64_t clockJumps_ = 0;
};

}  // namespace pleinair::hal
