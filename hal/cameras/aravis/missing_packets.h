#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace pleinair::hal::aravis {

/// Counts the packets of a GigE Vision stream that did not come, nor when they were asked for
/// again. Aravis counts from the first that a frame lacks to the frame's end. Here they are what
/// the frames that have ended consist of, less what was received: exact whenever no later frame is
/// on its way, and else too few by its packets until then. Of frames of which no packet came it
/// knows nothing.
class MissingPackets {
 public:
  MissingPackets() = default;
  /// `packetBytes`: with the headers of IP (20), UDP (8) and GVSP (8, or 20 with long ids). 0: it
  /// counts nothing.
  MissingPackets(std::size_t payloadBytes, std::size_t packetBytes, bool hasLongIds) {
    const std::size_t headers = hasLongIds ? 48 : 36;
    if (packetBytes <= headers) return;
    const std::size_t room = packetBytes - headers;
    perFrame_ = (payloadBytes + room - 1) / room + 2;  // a leader and a trailer
  }

  bool counts() const { return perFrame_ > 0; }
  /// Leader and trailer included; 0: unknown.
  std::uint64_t perFrame() const { return perFrame_; }
  /// A frame has ended, whole or not. `received`: packets that belonged to an awaited frame, each
  /// once, since the stream began.
  void frameEnded(std::uint64_t received) {
    expected_ += perFrame_;
    if (expected_ > received) missing_ = std::max(missing_, expected_ - received);
  }
  std::uint64_t count() const { return missing_; }

 private:
  std::uint64_t perFrame_ = 0;
  std::uint64_t expected_ = 0;
  std::uint64_t missing_ = 0;
};

}  // namespace pleinair::hal::aravis
