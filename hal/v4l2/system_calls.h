#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <poll.h>

#include "hal/clock.h"

namespace pleinair::hal::v4l2 {

/// The system calls behind V4L2 devices; tests inject a fake device. Each call gives −errno in
/// place of −1 and retries EINTR. Thread-safe. Must outlive every camera, output and frame that
/// uses it.
class SystemCalls {
 public:
  virtual ~SystemCalls() = default;
  SystemCalls() = default;
  SystemCalls(const SystemCalls&) = delete;
  SystemCalls& operator=(const SystemCalls&) = delete;

  /// Opens a device node and gives its file descriptor. O_CLOEXEC is added to `flags`.
  virtual int open(const char* path, int flags) = 0;
  /// Closes a descriptor. Never retried: the descriptor is gone whatever the answer.
  virtual int close(int fd) = 0;
  virtual int ioctl(int fd, unsigned long request, void* argument) = 0;
  /// Maps memory, shared, readable and writable. 0, with `address` set.
  virtual int map(int fd, std::size_t length, std::int64_t offset, void*& address) = 0;
  virtual int unmap(void* address, std::size_t length) = 0;
  /// Waits, and gives the number of ready descriptors in `waitFor`; 0 after `timeout`. Without
  /// `timeout` it waits for ever.
  virtual int poll(std::span<pollfd> waitFor, std::optional<Duration> timeout) = 0;
  /// Writes, and gives the number of bytes written, which may be fewer.
  virtual std::int64_t write(int fd, std::span<const std::uint8_t> bytes) = 0;
};

/// The kernel's system calls.
SystemCalls& kernelCalls();

}  // namespace pleinair::hal::v4l2
