#pragma once

#include <functional>
#include <string>

namespace pleinair::support {

/// How often our own code calls operator new during `work`, on any thread. Ours is what is linked
/// into this program: a call counts by the stack it came from, past the C++ library's frames (which
/// is where std::string allocates). What OpenCV, Mesa and LLVM, shared libraries all, ask for
/// themselves does not count. A program that links this has its global operator new replaced.
int allocationsIn(const std::function<void()>& work);

/// Where the first few of the last allocationsIn() came from, for addr2line.
std::string allocationSites();

}  // namespace pleinair::support
