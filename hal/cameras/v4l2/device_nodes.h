#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hal/v4l2/system_calls.h"

namespace pleinair::hal::v4l2 {

/// The parts of the file system where the kernel and udev say what devices there are; a test says
/// its own. One thread at a time.
class DeviceNodes {
 public:
  virtual ~DeviceNodes() = default;
  DeviceNodes() = default;
  DeviceNodes(const DeviceNodes&) = delete;
  DeviceNodes& operator=(const DeviceNodes&) = delete;

  /// The names in a folder, in no order; none where there is no such folder.
  virtual std::vector<std::string> list(const std::string& folder) = 0;
  /// Where a symbolic link leads in the end: "/dev/video0".
  virtual std::optional<std::string> target(const std::string& link) = 0;
  /// The first line of a file, without its end; nothing where it cannot be read.
  virtual std::optional<std::string> firstLine(const std::string& file) = 0;
};

/// This system's.
DeviceNodes& kernelNodes();

/// What cameras and their listing reach devices through. Both outlive what uses them, frames too.
struct System {
  SystemCalls& calls;
  DeviceNodes& nodes;
};

inline System kernelSystem() {
  return {.calls = kernelCalls(), .nodes = kernelNodes()};
}

}  // namespace pleinair::hal::v4l2
