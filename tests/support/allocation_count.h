#pragma once

#include <functional>
#include <string>

namespace pleinair::support {

/// How often the program's own code calls operator new during `work`, on any thread. A call counts
/// if its stack leads to code linked into this program; frames of the C++ library are skipped
/// (std::string allocates there). Calls from OpenCV, Mesa and LLVM, all shared libraries, do not
/// count. Linking this file replaces the program's global operator new.
int allocationsIn(const std::function<void()>& work);

/// The addresses of the first few of the last allocationsIn(), for addr2line.
std::string allocationSites();

}  // namespace pleinair::support
