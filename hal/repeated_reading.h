#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <pthread.h>

#include "hal/clock.h"

namespace pleinair::hal {

/// Calls a function again and again on a thread of its own, and keeps what it answered last: for
/// what may take long, or hang in a driver. Any thread.
template <class Value>
class RepeatedReading {
 public:
  /// Begins at once. `name`: the thread's, of at most 15 characters. `interval`: real time between
  /// two calls. `read` owns whatever it uses, because a call that hangs outlives this.
  RepeatedReading(std::string name, std::function<Value()> read, Duration interval)
      : shared_(std::make_shared<Shared>()) {
    // Detached: a call that hangs could not be joined.
    std::thread([shared = shared_, name = std::move(name), read = std::move(read), interval] {
      pthread_setname_np(pthread_self(), name.c_str());
      run(*shared, read, interval);
    }).detach();
  }
  /// Takes at most 200 ms; a call that hangs is left behind.
  ~RepeatedReading() {
    std::unique_lock lock(shared_->mutex);
    shared_->isStopping = true;
    shared_->changed.notify_all();
    shared_->changed.wait_for(lock, kEndPatience, [this] { return shared_->hasEnded; });
  }
  RepeatedReading(const RepeatedReading&) = delete;
  RepeatedReading& operator=(const RepeatedReading&) = delete;

  struct Reading {
    std::uint64_t number = 0;  ///< how many there were, with this one
    Value value;
  };
  /// The last one; nothing before the first.
  std::optional<Reading> latest() const {
    const std::scoped_lock lock(shared_->mutex);
    return shared_->latest;
  }

 private:
  static constexpr Duration kEndPatience = std::chrono::milliseconds(200);

  struct Shared {
    std::mutex mutex;
    std::condition_variable changed;
    std::optional<Reading> latest;
    bool isStopping = false;
    bool hasEnded = false;
  };

  static void run(Shared& shared, const std::function<Value()>& read, Duration interval) {
    std::uint64_t number = 0;
    for (;;) {
      Value value = read();
      std::unique_lock lock(shared.mutex);
      shared.latest = Reading{.number = ++number, .value = std::move(value)};
      shared.changed.wait_for(lock, interval, [&] { return shared.isStopping; });
      if (!shared.isStopping) continue;
      shared.hasEnded = true;
      shared.changed.notify_all();
      return;
    }
  }

  std::shared_ptr<Shared> shared_;
};

}  // namespace pleinair::hal
