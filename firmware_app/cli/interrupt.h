#pragma once

#include <array>
#include <csignal>
#include <string_view>

namespace pleinair::app {

/// The exit status of a program that a signal ended is this number plus the signal's, as in shells.
inline constexpr int kSignalExitBase = 128;

/// Catches SIGINT, SIGTERM and SIGHUP, so that loops can poll received() and close their files in
/// order. A second signal ends the process at once. An ignored signal (as under nohup) stays
/// ignored. The destructor restores the former actions. One instance per process.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// The number of the received signal, or 0. Any thread.
  static int received();

 private:
  static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, kSignals.size()> former_{};
};

/// The name of a signal that Interrupt catches: "SIGTERM".
std::string_view signalName(int signal);

}  // namespace pleinair::app
