#pragma once

#include <cstdlib>

namespace pleinair::support {

/// Sets an environment variable, or unsets it (nullptr). Only while the process has one thread.
inline void setVariable(const char* name, const char* value) {
  // NOLINTBEGIN(concurrency-mt-unsafe)
  if (value == nullptr) {
    unsetenv(name);
  } else {
    setenv(name, value, 1);
  }
  // NOLINTEND(concurrency-mt-unsafe)
}

}  // namespace pleinair::support
