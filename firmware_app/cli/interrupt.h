#pragma once

#include <array>
#include <csignal>
#include <string_view>

namespace pleinair::app {

/// What the exit status of a program that a signal ended adds to the signal's number, as in shells.
inline constexpr int kSignalExitBase = 128;

/// Turns SIGINT, SIGTERM and SIGHUP into a question that loops ask, so that files are left in
/// order. A second time, each ends the process at once. What
/// was ignored (as nohup has it) stays ignored. The former actions come back at the end. One a
/// process.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// The signal's number, or 0 if there was none. Any thread.
  static int received();

 private:
  static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, kSignals.size()> former_{};
};

/// "SIGTERM", of those that Interrupt takes.
std::string_view signalName(int signal);

}  // namespace pleinair::app
