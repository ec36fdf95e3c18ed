#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace pleinair::hal::aravis {

/// Packets of payload in a frame of a GigE Vision stream. `packetBytes`: with the headers of IP
/// (20), UDP (8) and GVSP (8, or 20 with long ids). 0 where they leave no room.
inline std::uint64_t partsOf(std::size_t frameBytes, std::size_t packetBytes, bool hasLongIds) {
  const std::size_t headers = hasLongIds ? 48 : 36;
  if (packetBytes <= headers) return 0;
  const std::size_t room = packetBytes - headers;
  return frameBytes / room + (frameBytes % room == 0 ? 0 : 1);
}

/// Counts the packets of a GigE Vision stream that did not come, nor when they were asked for
/// again. Aravis counts from the first that a frame lacks to the frame's end. Here they are what
/// the frames that have ended consist of, less what was received: exact whenever no later frame is
/// on its way and incomplete frames have the announced size, and else too few by its packets until
/// then. Of frames of which no packet came it knows nothing.
class MissingPackets {
 public:
  MissingPackets() = default;
  /// `payloadBytes`: the announced size of a frame. `packetBytes`: as of partsOf(). Counts nothing
  /// where packets have no room.
  MissingPackets(std::size_t payloadBytes, std::size_t packetBytes, bool hasLongIds)
      : payloadBytes_(payloadBytes),
        packetBytes_(packetBytes),
        hasLongIds_(hasLongIds),
        counts_(partsOf(payloadBytes, packetBytes, hasLongIds) > 0) {}

  bool counts() const { return counts_; }
  /// A frame has ended. `received`: packets that belonged to an awaited frame, each once, since the
  /// stream began. `wholeBytes`: the size of a whole frame, which cameras may announce too large or
  /// too small; unset for others.
  void frameEnded(std::uint64_t received, std::optional<std::size_t> wholeBytes) {
    if (!counts_) return;
    constexpr std::uint64_t kLeaderAndTrailer = 2;
    expected_ +=
        kLeaderAndTrailer + partsOf(wholeBytes.value_or(payloadBytes_), packetBytes_, hasLongIds_);
    if (expected_ > received) missing_ = std::max(missing_, expected_ - received);
  }
  std::uint64_t count() const { return missing_; }

 private:
  std::size_t payloadBytes_ = 0;
  std::size_t packetBytes_ = 0;
  bool hasLongIds_ = false;
  bool counts_ = false;
  std::uint64_t expected_ = 0;
  std::uint64_t missing_ = 0;
};

}  // namespace pleinair::hal::aravis
