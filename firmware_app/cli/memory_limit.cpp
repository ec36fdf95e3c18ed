#include "firmware_app/cli/memory_limit.h"

#include <array>
#include <csignal>
#include <string>

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

namespace pleinair::app {
namespace {

/// Made beforehand: a handler may not allocate.
std::string& notice() {
  static std::string text;
  return text;
}

/// The signal's own action is in force again (SA_RESETHAND): what crashed crashes again, and the
/// process ends with the signal.
void say(int) {
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, notice().data(), notice().size());
}

/// LLVM aborts where it runs out of memory.
void sayAndEnd(int signal) {
  say(signal);
  raise(signal);
}

}  // namespace

std::string memoryLimitText() {
  rlimit memory{};
  if (getrlimit(RLIMIT_AS, &memory) != 0 || memory.rlim_cur == RLIM_INFINITY) return {};
  return fmt::format("this process may use {} MiB of address space (ulimit -v)",
                     memory.rlim_cur >> 20U);
}

void explainCrashesUnderAMemoryLimit() {
  const std::string limit = memoryLimitText();
  if (limit.empty()) return;
  notice() = fmt::format(
      "pleinair: a crash, probably for want of memory: {}, and graphics drivers do not survive "
      "without more: raise that limit first\n",
      limit);
  struct sigaction action {};
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  action.sa_handler = say;
  for (const int signal : std::array{SIGSEGV, SIGBUS}) sigaction(signal, &action, nullptr);
  action.sa_handler = sayAndEnd;
  sigaction(SIGABRT, &action, nullptr);
}

}  // namespace pleinair::app
