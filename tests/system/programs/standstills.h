#pragma once

#include <atomic>
#include <chrono>
#include <fstream>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include "hal/clock.h"
#include "pipeline/runtime/thread_role.h"

namespace pleinair {

/// When the machine stood still, as an emulated one does whenever its host does something else.
/// Threads, one pinned to each processor and as prompt as those of the pipeline, sleep for a few
/// milliseconds again and again: where one wakes late, no program could have been in time.
class Standstills {
 public:
  explicit Standstills(const hal::Clock& clock) {
    for (unsigned each = 0; each < std::thread::hardware_concurrency(); ++each) {
      threads_.emplace_back([this, &clock, each] { run(clock, each); });
    }
  }
  ~Standstills() {
    ends_ = true;
    for (std::thread& each : threads_) each.join();
  }
  Standstills(const Standstills&) = delete;
  Standstills& operator=(const Standstills&) = delete;

  /// A row for each so far: from when to when, in seconds on the steady clock.
  void write(const std::string& file) {
    const std::scoped_lock lock(mutex_);
    std::ofstream rows(file);
    rows << "from_s,to_s\n";
    for (const auto& [from, to] : stills_) {
      rows << fmt::format("{:.6f},{:.6f}\n", hal::toSeconds(from.time_since_epoch()),
                          hal::toSeconds(to.time_since_epoch()));
    }
  }

 private:
  static constexpr hal::Duration kInterval = std::chrono::milliseconds(4);
  static constexpr hal::Duration kLate = std::chrono::milliseconds(3);

  void run(const hal::Clock& clock, unsigned processor) {
    runtime::setThreadRole("standstills", runtime::ThreadRole::kPrompt);
    cpu_set_t only;
    CPU_ZERO(&only);
    CPU_SET(processor, &only);
    ::pthread_setaffinity_np(::pthread_self(), sizeof(only), &only);
    while (!ends_) {
      const hal::TimePoint wanted = clock.now() + kInterval;
      std::this_thread::sleep_for(kInterval);
      const hal::TimePoint woke = clock.now();
      if (woke - wanted < kLate) continue;
      const std::scoped_lock lock(mutex_);
      stills_.emplace_back(wanted, woke);
    }
  }

  std::atomic<bool> ends_ = false;
  std::mutex mutex_;
  std::vector<std::pair<hal::TimePoint, hal::TimePoint>> stills_;
  std::vector<std::thread> threads_;
};

}  // namespace pleinair
