#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <linux/filter.h>

namespace pleinair::hal::aravis {

/// The packets that a GigE Vision stream may consist of.
struct StreamPackets {
  std::uint32_t camera = 0;       ///< IPv4 address, in the host's byte order
  std::size_t bufferBytes = 0;    ///< what a frame is written to
  std::uint32_t packetBytes = 0;  ///< with the headers of IP, UDP and GVSP
};

/// A program for a UDP socket (SO_ATTACH_FILTER) that drops all but the leaders, trailers and
/// payload packets of such a stream. Aravis (0.8.26) takes sizes and places for granted: a datagram
/// that is shorter than its headers, whose number is too large for the buffer, or that announces a
/// frame of several parts, makes it write beside the buffer or ask for gigabytes. Empty where
/// packets have no room for anything.
std::vector<sock_filter> packetFilter(const StreamPackets& packets);

/// Attaches it to this process' UDP socket at that port of the interface with that IPv4 address
/// (host's byte order; 0: any). False where there is none, or the kernel takes no filter. Any
/// thread.
[[nodiscard]] bool filterPackets(std::uint32_t interface, std::uint16_t port,
                                 const StreamPackets& packets);

}  // namespace pleinair::hal::aravis
