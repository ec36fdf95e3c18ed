#pragma once

#include <functional>

namespace pleinair::support {

/// How often `work` calls operator new on this thread. A program that links this has its global
/// operator new replaced.
int allocationsIn(const std::function<void()>& work);

}  // namespace pleinair::support
