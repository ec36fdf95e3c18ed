#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hal/v4l2/system_calls.h"

namespace pleinair::hal::v4l2 {

/// The parts of the file system in which the kernel and udev describe the devices; injected for
/// tests. One thread at a time.
class DeviceNodes {
 public:
  virtual ~DeviceNodes() = default;
  DeviceNodes() = default;
  DeviceNodes(const DeviceNodes&) = delete;
  DeviceNodes& operator=(const DeviceNodes&) = delete;

  /// The names in a folder, in no order; empty if the folder does not exist.
  virtual std::vector<std::string> list(const std::string& folder) = 0;
  /// The final target of a symbolic link: "/dev/video0".
  virtual std::optional<std::string> target(const std::string& link) = 0;
  /// The first line of a file, without its end; nothing if the file cannot be read.
  virtual std::optional<std::string> firstLine(const std::string& file) = 0;
};

/// The nodes of the running system.
DeviceNodes& kernelNodes();

/// The access to devices for cameras and their listing. Both members outlive their users, frames
/// included.
struct System {
  SystemCalls& calls;
  DeviceNodes& nodes;
};

inline System kernelSystem() {
  return {.calls = kernelCalls(), .nodes = kernelNodes()};
}

}  // namespace pleinair::hal::v4l2
