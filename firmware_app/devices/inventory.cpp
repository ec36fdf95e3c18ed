#include "firmware_app/devices/inventory.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

namespace pleinair::app {

DeviceCameras listDeviceCameras(std::span<const hal::SelectableBackend> backends) {
  DeviceCameras all;
  for (const hal::SelectableBackend& each : backends) {
    hal::Result<std::vector<hal::CameraDescription>> cameras = each.backend->list();
    if (cameras) {
      std::ranges::move(*cameras, std::back_inserter(all.cameras));
    } else {
      all.problems.push_back(std::move(cameras.error()));
    }
  }
  return all;
}

std::vector<KindOfOutputs> listOutputs(std::span<const hal::OutputKind> kinds) {
  std::vector<KindOfOutputs> all;
  for (const hal::OutputKind& kind : kinds) {
    all.push_back({.kind = kind.name,
                   .help = kind.help,
                   .forms = kind.forms,
                   .isFile = kind.traits.writesFiles,
                   .listing = kind.list == nullptr ? hal::OutputListing{} : kind.list()});
  }
  return all;
}

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxModes = 256;

std::vector<std::string> linesOf(const fs::path& path) {
  std::vector<std::string> lines;
  std::ifstream file(path);
  for (std::string line; lines.size() < kMaxModes && std::getline(file, line);) {
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
