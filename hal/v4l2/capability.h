#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/error.h"
#include "hal/v4l2/system_calls.h"

namespace pleinair::hal::v4l2 {

/// What VIDIOC_QUERYCAP says of one node.
struct Capability {
  std::string driver;
  std::string card;
  std::string bus;          ///< "usb-0000:00:14.0-4", "platform:vivid-000"
  std::uint32_t flags = 0;  ///< V4L2_CAP_… of this node, not of its whole device

  bool has(std::uint32_t flag) const { return (flags & flag) != 0; }
  bool capturesVideo() const;  ///< single- or multi-planar; memory-to-memory devices do not
  bool outputsVideo() const;   ///< likewise
};

/// Errors: kUnsupported (no V4L2 device), kNotFound (gone meanwhile), kIo. `subject` names the
/// node.
Result<Capability> queryCapability(SystemCalls& calls, int fd, const std::string& subject);

/// 3 of "video3", the name of a V4L2 node in /dev; nothing of other names.
std::optional<int> videoNumber(std::string_view name);

}  // namespace pleinair::hal::v4l2
