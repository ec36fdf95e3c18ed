#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <poll.h>

#include "hal/clock.h"
#include "hal/file_descriptor.h"

namespace pleinair::hal::v4l2 {

/// The system calls that drive V4L2 devices; tests simulate a device behind them.
/// Every call answers −errno where the system says −1, and goes on by itself after EINTR.
/// Thread-safe. Outlives every camera, output and frame that uses it.
class SystemCalls : public DescriptorCloser {
 public:
  SystemCalls() = default;
  ~SystemCalls() override = default;
  SystemCalls(const SystemCalls&) = delete;
  SystemCalls& operator=(const SystemCalls&) = delete;

  /// A descriptor, which a FileDescriptor closes with this. O_CLOEXEC is added to `flags`.
  virtual int open(const char* path, int flags) = 0;
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
