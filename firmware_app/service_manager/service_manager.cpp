#include "firmware_app/service_manager/service_manager.h"

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace pleinair::app {
namespace {

std::string takeVariable(const char* name) {
  const char* const value = std::getenv(name);
  std::string text = value == nullptr ? "" : value;
  unsetenv(name);
  return text;
}

std::optional<std::int64_t> numberIn(std::string_view text) {
  std::int64_t number = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (text.empty() || status != std::errc() || end != text.data() + text.size()) return {};
  return number;
}

std::optional<hal::Duration> watchdogPeriodOf(const ServiceEnvironment& environment) {
  if (!environment.watchdogPid.empty() && numberIn(environment.watchdogPid) != getpid()) return {};
  const auto period = numberIn(environment.watchdogUsec);
  if (!period || *period <= 0) return std::nullopt;
  return std::chrono::microseconds(*period);
}

}  // namespace

ServiceEnvironment takeServiceEnvironment() {
  return {.notifySocket = takeVariable("NOTIFY_SOCKET"),
          .watchdogUsec = takeVariable("WATCHDOG_USEC"),
          .watchdogPid = takeVariable("WATCHDOG_PID")};
}

ServiceManager::ServiceManager(const ServiceEnvironment& environment)
    : address_(environment.notifySocket) {
  const bool isName = address_.starts_with('/') || address_.starts_with('@');
  if (!isName || address_.size() >= sizeof(sockaddr_un::sun_path)) return;
  if (address_.front() == '@') address_.front() = '\0';
  socket_ = hal::FileDescriptor(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  watchdogPeriod_ = watchdogPeriodOf(environment);
}

void ServiceManager::notify(std::string_view assignments) const {
  if (!socket_) return;
  sockaddr_un there{};
  there.sun_family = AF_UNIX;
  std::memcpy(static_cast<char*>(there.sun_path), address_.data(), address_.size());
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address_.size());
  static_cast<void>(sendto(socket_.get(), assignments.data(), assignments.size(),
                           MSG_NOSIGNAL | MSG_DONTWAIT,
                           reinterpret_cast<const sockaddr*>(&there),  // NOLINT(*-cast)
                           length));
}

}  // namespace pleinair::app
