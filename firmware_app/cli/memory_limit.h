#pragma once

#include <string>

namespace pleinair::app {

/// "this process may use 450 MiB of address space (ulimit -v)"; empty where there is no limit.
std::string memoryLimitText();

/// Where the address space of this process is limited, a crash says so on standard error before it
/// ends the process with its signal: drivers do not check every allocation, and crash where one
/// fails. Elsewhere nothing is done. Call once, before other threads are started.
void explainCrashesUnderAMemoryLimit();

}  // namespace pleinair::app
