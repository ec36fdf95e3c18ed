#include "firmware_app/devices/displays.h"

#include <algorithm>
#include <fstream>
#include <system_error>

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostModes = 256;

std::vector<std::string> linesOf(const fs::path& path) {
  std::vector<std::string> lines;
  std::ifstream file(path);
  for (std::string line; lines.size() < kMostModes && std::getline(file, line);) {
    // The kernel lists a size once for each of its rates.
    if (std::ranges::find(lines, line) == lines.end()) lines.push_back(line);
  }
  return lines;
}

}  // namespace

std::vector<Display> listDisplays(const fs::path& folder) {
  std::vector<Display> displays;
  std::error_code failure;
  for (fs::directory_iterator each(folder, failure), end; !failure && each != end;
       each.increment(failure)) {
    std::error_code ignored;
    const fs::path status = each->path() / "status";
    if (!fs::exists(status, ignored)) continue;  // a card itself, or a render node
    const std::vector<std::string> lines = linesOf(status);
    displays.push_back({.name = each->path().filename().string(),
                        .isConnected = !lines.empty() && lines.front() == "connected",
                        .modes = linesOf(each->path() / "modes")});
  }
  std::ranges::sort(displays, {}, &Display::name);
  return displays;
}

}  // namespace pleinair::app
