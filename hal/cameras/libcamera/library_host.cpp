#include "hal/cameras/libcamera/library_host.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <mutex>
#include <thread>

#include <sys/wait.h>

namespace pleinair::hal::libcamera {
namespace {

/// What the kernel has to end a process that was killed.
constexpr Duration kKillLimit = std::chrono::milliseconds(200);

}  // namespace

HostProcess::~HostProcess() {
  end(Duration::zero());
}

void HostProcess::end(Duration limit) {
  if (process_ < 0 || waitFor(limit)) return;
  ::kill(process_, SIGKILL);
  if (waitFor(kKillLimit)) return;
  static std::mutex mutex;
  static std::vector<pid_t> hanging;
  const std::scoped_lock lock(mutex);
  std::erase_if(hanging, [](pid_t each) { return ::waitpid(each, nullptr, WNOHANG) != 0; });
  hanging.push_back(process_);
  process_ = -1;
}

std::string HostProcess::endText() {
  if (process_ >= 0) waitFor(kKillLimit);
  if (WIFSIGNALED(status_)) return "was ended by signal " + std::to_string(WTERMSIG(status_));
  return "has ended";
}

bool HostProcess::waitFor(Duration limit) {
  const auto until = std::chrono::steady_clock::now() + limit;
  for (;;) {
    const pid_t ended = ::waitpid(process_, &status_, WNOHANG);
    if (ended == process_ || (ended < 0 && errno != EINTR)) {
      process_ = -1;
      return true;
    }
    if (std::chrono::steady_clock::now() >= until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

}  // namespace pleinair::hal::libcamera
