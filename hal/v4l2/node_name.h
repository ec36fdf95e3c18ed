#pragma once

#include <optional>
#include <string_view>

namespace pleinair::hal::v4l2 {

/// 3 of "video3", the name of a V4L2 node in /dev; nothing of other names.
std::optional<int> videoNumber(std::string_view name);

}  // namespace pleinair::hal::v4l2
