#pragma once

#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

namespace pleinair::support {

/// Calls `attempt` until what it gives is true, and returns that. For work of other threads, whose
/// end no clock of a test can bring about. Throws std::runtime_error naming `what` after a minute,
/// so that a test fails and does not hang its suite.
template <class Attempt>
auto awaited(const std::string& what, const Attempt& attempt) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  for (;;) {
    if (auto outcome = attempt()) return outcome;
    if (std::chrono::steady_clock::now() > deadline) {
      throw std::runtime_error("waited for a minute: " + what);
    }
    std::this_thread::yield();
  }
}

}  // namespace pleinair::support
