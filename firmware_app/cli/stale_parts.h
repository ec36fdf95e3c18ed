#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pleinair::app {

/// A line for each partial movie or picture in the folder of `output` that a killed run left
/// (hal::stalePartsIn()), with what can be done with it. They are not removed: what there is of a
/// movie can be played. Call it once the output is started, which takes over the parts of its own
/// name.
std::vector<std::string> stalePartNotices(const std::filesystem::path& output);

}  // namespace pleinair::app
