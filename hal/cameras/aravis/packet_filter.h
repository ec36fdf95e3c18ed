#pragma once

#include <cstdint>
#include <vector>

#include <linux/filter.h>

namespace pleinair::hal::aravis {

/// The packets that a GigE Vision stream consists of.
struct StreamPackets {
  std::uint32_t camera = 0;    ///< IPv4 address, in the host's byte order
  std::uint32_t perFrame = 0;  ///< leader and trailer included
};

/// A program for a UDP socket (SO_ATTACH_FILTER) that drops all but the leaders, trailers and
/// payload packets of such a stream. Aravis (0.8.26) takes sizes and places for granted: a datagram
/// that is shorter than its headers, or has a larger number than its frame has packets, makes it
/// write beside the buffer.
std::vector<sock_filter> packetFilter(const StreamPackets& packets);

/// Attaches it to this process' UDP socket at that port. False where there is none, or the kernel
/// takes no filter. Any thread.
bool filterPackets(std::uint16_t port, const StreamPackets& packets);

}  // namespace pleinair::hal::aravis
