#pragma once

#include <utility>

#include "hal/v4l2/system_calls.h"

namespace pleinair::hal::v4l2 {

/// Owns a file descriptor that `calls` opened; closes it on any thread.
class Descriptor {
 public:
  Descriptor() = default;
  Descriptor(SystemCalls& calls, int fd) : calls_(&calls), fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept
      : calls_(other.calls_), fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    if (this == &other) return *this;
    reset();
    calls_ = other.calls_;
    fd_ = std::exchange(other.fd_, -1);
    return *this;
  }
  ~Descriptor() { reset(); }

  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }
  void reset() {
    if (fd_ >= 0) calls_->close(std::exchange(fd_, -1));
  }

 private:
  SystemCalls* calls_ = nullptr;
  int fd_ = -1;
};

}  // namespace pleinair::hal::v4l2
