#include "firmware_app/service_manager/passed_socket.h"

#include <charconv>
#include <cstdlib>
#include <string>
#include <utility>

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace pleinair::app {
namespace {

constexpr int kFirstPassed = 3;
constexpr int kMostPassed = 64;  // more than any unit passes; guards against a wrong variable

/// 0 where it is no number.
int takeNumber(const char* name) {
  const char* const value = std::getenv(name);
  const std::string text = value == nullptr ? "" : value;
  unsetenv(name);
  int number = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
  return status == std::errc() && end == text.data() + text.size() ? number : 0;
}

bool listens(int descriptor) {
  int isListening = 0;
  socklen_t length = sizeof isListening;
  return getsockopt(descriptor, SOL_SOCKET, SO_ACCEPTCONN, &isListening, &length) == 0 &&
         isListening != 0;
}

}  // namespace

hal::FileDescriptor takePassedSocket() {
  const int process = takeNumber("LISTEN_PID");
  const int count = takeNumber("LISTEN_FDS");
  unsetenv("LISTEN_FDNAMES");
  hal::FileDescriptor chosen;
  if (process != getpid() || count <= 0 || count > kMostPassed) return chosen;
  for (int each = kFirstPassed; each < kFirstPassed + count; ++each) {
    hal::FileDescriptor passed(each);
    fcntl(each, F_SETFD, FD_CLOEXEC);
    if (!chosen && listens(each)) chosen = std::move(passed);
  }
  return chosen;
}

}  // namespace pleinair::app
