#include "pipeline/runtime/thread_role.h"

#include <pthread.h>
#include <sched.h>

namespace pleinair::runtime {

bool setThreadRole(const std::string& name, ThreadRole role) {
  constexpr std::size_t kMaxNameLength = 15;
  pthread_setname_np(pthread_self(), name.substr(0, kMaxNameLength).c_str());
  if (role == ThreadRole::kOrdinary) return false;
  const sched_param parameters{.sched_priority = kPromptPriority};
  return pthread_setschedparam(pthread_self(), SCHED_RR, &parameters) == 0;
}

}  // namespace pleinair::runtime
