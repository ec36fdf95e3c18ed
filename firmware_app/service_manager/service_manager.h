#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "hal/clock.h"
#include "hal/file_descriptor.h"

namespace pleinair::app {

/// The variables by which a service manager tells a process where it listens; empty: not set.
struct ServiceEnvironment {
  std::string notifySocket;  ///< $NOTIFY_SOCKET: a path, or '@' and an abstract name
  std::string watchdogUsec;  ///< $WATCHDOG_USEC: microseconds between two signs of life
  std::string watchdogPid;   ///< $WATCHDOG_PID: the process that the watchdog is for; empty: any
};

/// Takes the variables out of the environment, so that no child is mistaken for this process.
ServiceEnvironment takeServiceEnvironment();

/// The service manager that started this process, where one did: messages of sd_notify(3) over a
/// datagram socket. One thread.
class ServiceManager {
 public:
  explicit ServiceManager(const ServiceEnvironment& environment);

  /// Whether a service manager listens.
  bool isThere() const { return static_cast<bool>(socket_); }
  /// So often it wants notify("WATCHDOG=1"), else it ends this process; unset: it does not care.
  std::optional<hal::Duration> watchdogPeriod() const { return watchdogPeriod_; }
  /// Sends assignments, one a line: "READY=1". Never waits; a message that cannot be delivered is
  /// lost, as with sd_notify().
  void notify(std::string_view assignments) const;

 private:
  hal::FileDescriptor socket_;
  std::string address_;  ///< the first byte is 0 for an abstract name
  std::optional<hal::Duration> watchdogPeriod_;
};

}  // namespace pleinair::app
