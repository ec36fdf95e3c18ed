#pragma once

#include <string>

namespace pleinair::runtime {

/// The real-time priority of prompt threads: above all ordinary threads, below the kernel's own
/// interrupt threads (50).
inline constexpr int kPromptPriority = 10;

/// What a thread is for, and so how urgently it runs.
enum class ThreadRole {
  kOrdinary,
  kPrompt,  ///< does little, but at its time: captures and presents
};

/// Names the calling thread (15 characters are kept) and sets its priority. A prompt one gets
/// SCHED_RR at kPromptPriority where the system allows it (RLIMIT_RTPRIO, CAP_SYS_NICE), which is
/// what it returns.
bool setThreadRole(const std::string& name, ThreadRole role);

}  // namespace pleinair::runtime
