#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/file_descriptor.h"

namespace pleinair::hal::libcamera {

/// A message with the descriptors that came with it.
struct HostMessage {
  std::vector<std::uint8_t> bytes;
  std::vector<FileDescriptor> descriptors;
};

/// One end of a socket between the program and the process that hosts libcamera. Messages arrive
/// whole and in order. send() may be called on any thread, receive() on one at a time.
class HostChannel {
 public:
  enum class Reception { kMessage, kTimeout, kClosed };

  HostChannel() = default;
  explicit HostChannel(FileDescriptor socket) : socket_(std::move(socket)) {}

  /// Two ends. Errors: kIo.
  static Result<std::array<FileDescriptor, 2>> pair();

  /// Never waits. Returns false if the other end is closed, or does not take its messages out.
  bool send(std::span<const std::uint8_t> bytes, std::span<const int> descriptors = {}) const;
  /// Waits for a message; without a timeout until the other end is closed.
  Reception receive(HostMessage& message, std::optional<Duration> timeout) const;
  void close() { socket_.reset(); }

 private:
  FileDescriptor socket_;
};

}  // namespace pleinair::hal::libcamera
