#pragma once

#include <filesystem>
#include <vector>

#include "hal/keyboards/keyboard_device.h"

namespace pleinair::hal {

/// The input devices with keys or buttons, by number, from the kernel's list (`folder`, as
/// /sys/class/input). Opens no device and needs no permission.
std::vector<KeyboardDescription> listEvdevKeyboards(
    const std::filesystem::path& folder = "/sys/class/input");

}  // namespace pleinair::hal
