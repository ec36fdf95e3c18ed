#pragma once

#include <string>

namespace pleinair::runtime {

/// The real-time priority of prompt threads: above all ordinary threads, below the kernel's own
/// interrupt threads (50).
inline constexpr int kPromptPriority = 10;

/// The urgency of a thread.
enum class ThreadRole {
  kOrdinary,
  kPrompt,  ///< short work at fixed times: capturing, presenting
};

/// Names the calling thread (15 characters are kept) and sets its priority. A prompt thread gets
/// SCHED_RR at kPromptPriority if the system permits it (RLIMIT_RTPRIO, CAP_SYS_NICE). Returns
/// whether it did.
///
/// A prompt thread that computes for longer than the soft RLIMIT_RTTIME without a pause becomes an
/// ordinary one: late pictures are better than the end of the program, which the hard limit is. For
/// that, the process's handler of SIGXCPU is set.
bool setThreadRole(const std::string& name, ThreadRole role);

/// Whether a thread has lost its priority so since the last call. Any thread.
bool takeDemotion();

}  // namespace pleinair::runtime
