#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pleinair::app {

/// A connector of a graphics card, as the kernel lists it.
struct Display {
  std::string name;  ///< "card0-HDMI-A-1"
  bool isConnected = false;
  std::vector<std::string> modes;  ///< "1920x1080", the preferred one first; of one size once
};

/// Those in `folder`, which is /sys/class/drm; nothing where there is no such folder.
std::vector<Display> listDisplays(const std::filesystem::path& folder = "/sys/class/drm");

}  // namespace pleinair::app
