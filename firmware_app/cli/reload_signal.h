#pragma once

#include <csignal>

namespace pleinair::app {

/// Catches SIGHUP as a request to read the configuration again, as service managers send it, in
/// place of Interrupt, which must be made before and goes after this. The destructor restores the
/// former action. One instance per process.
class ReloadSignal {
 public:
  ReloadSignal();
  ~ReloadSignal();
  ReloadSignal(const ReloadSignal&) = delete;
  ReloadSignal& operator=(const ReloadSignal&) = delete;

  /// Whether the signal came since the last call. Any thread.
  static bool take();

 private:
  struct sigaction former_ {};
};

}  // namespace pleinair::app
