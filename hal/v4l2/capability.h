#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/error.h"
#include "hal/v4l2/system_calls.h"

namespace pleinair::hal::v4l2 {

/// The answer of VIDIOC_QUERYCAP for one node.
struct Capability {
  std::string driver;
  std::string card;
  std::string bus;          ///< "usb-0000:00:14.0-4", "platform:vivid-000"
  std::uint32_t flags = 0;  ///< V4L2_CAP_… flags of this node, not of its whole device

  bool has(std::uint32_t flag) const { return (flags & flag) != 0; }
  bool capturesVideo() const;  ///< single- or multi-planar; false for memory-to-memory devices
  bool outputsVideo() const;   ///< single- or multi-planar; false for memory-to-memory devices
};

/// Queries a node. Errors: kUnsupported (no V4L2 device), kNotFound (gone meanwhile), kIo.
/// `subject` names the node.
Result<Capability> queryCapability(SystemCalls& calls, int fd, const std::string& subject);

/// The number in the name of a V4L2 node in /dev: 3 for "video3"; nothing for other names.
std::optional<int> videoNumber(std::string_view name);

}  // namespace pleinair::hal::v4l2
