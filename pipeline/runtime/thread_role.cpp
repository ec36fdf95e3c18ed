#include "pipeline/runtime/thread_role.h"

#include <atomic>
#include <cerrno>
#include <csignal>

#include <pthread.h>
#include <sched.h>

namespace pleinair::runtime {
namespace {

std::atomic<bool> wasDemoted = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal's handler sets it");

/// Of SIGXCPU, which the kernel delivers on the thread that has used its time up.
void demote(int /*signal*/) {
  const int saved = errno;
  if (sched_getscheduler(0) != SCHED_OTHER) {  // 0: the calling thread, in Linux
    const sched_param none{};
    if (sched_setscheduler(0, SCHED_OTHER, &none) == 0) wasDemoted = true;
  }
  errno = saved;
}

void demoteAtTheLimit() {
  struct sigaction action {};
  action.sa_handler = demote;
  action.sa_flags = SA_RESTART;
  sigaction(SIGXCPU, &action, nullptr);
}

}  // namespace

bool setThreadRole(const std::string& name, ThreadRole role) {
  constexpr std::size_t kMaxNameLength = 15;
  pthread_setname_np(pthread_self(), name.substr(0, kMaxNameLength).c_str());
  if (role == ThreadRole::kOrdinary) return false;
  demoteAtTheLimit();
  const sched_param parameters{.sched_priority = kPromptPriority};
  return pthread_setschedparam(pthread_self(), SCHED_RR, &parameters) == 0;
}

bool takeDemotion() {
  return wasDemoted.exchange(false);
}

}  // namespace pleinair::runtime
