#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

#include "hal/clock.h"

namespace pleinair::runtime {

/// Passes values from one thread to another. It holds at most one, which a newer one replaces.
template <class T>
class Mailbox {
 public:
  /// Stores `value`; gives the value that it replaced.
  std::optional<T> put(T value) {
    const std::scoped_lock lock(mutex_);
    std::optional<T> replaced = std::exchange(value_, std::optional<T>(std::move(value)));
    changed_.notify_all();
    return replaced;
  }

  std::optional<T> take() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(value_, std::nullopt);
  }

  /// Returns once there is a value, after wake(), or after `patience` of real time.
  void wait(hal::Duration patience) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, patience, [this] { return value_.has_value() || isWoken_; });
    isWoken_ = false;
  }

  void wake() {
    const std::scoped_lock lock(mutex_);
    isWoken_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<T> value_;
  bool isWoken_ = false;
};

}  // namespace pleinair::runtime
