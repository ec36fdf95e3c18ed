#pragma once

namespace pleinair::app {

/// Turns SIGINT and SIGTERM into a question that loops ask, so that files are left in order. A
/// second signal ends the process at once. One a process.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// The signal's number, or 0 if there was none. Any thread.
  static int received();
};

}  // namespace pleinair::app
