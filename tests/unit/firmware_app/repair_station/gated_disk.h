#pragma once

#include <condition_variable>
#include <mutex>

#include "pipeline/record/record_file.h"

namespace pleinair::app {

/// A disk that hangs while it is shut: a line that was written waits to be synchronised. Outlives
/// who writes. Any thread.
class GatedDisk {
 public:
  record::RecordSystem system() {
    record::RecordSystem system = record::RecordSystem::real();
    system.sync = [this, sync = system.sync](int fd) {
      std::unique_lock lock(mutex_);
      isWaiting_ = isShut_;
      changed_.notify_all();
      changed_.wait(lock, [this] { return !isShut_; });
      isWaiting_ = false;
      return sync(fd);
    };
    return system;
  }
  void shut() {
    const std::scoped_lock lock(mutex_);
    isShut_ = true;
  }
  void open() {
    const std::scoped_lock lock(mutex_);
    isShut_ = false;
    changed_.notify_all();
  }
  /// Until somebody waits at it.
  void awaitWaiting() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return isWaiting_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool isShut_ = false;
  bool isWaiting_ = false;
};

}  // namespace pleinair::app
