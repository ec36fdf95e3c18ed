#include "hal/cameras/v4l2/device_nodes.h"

#include <filesystem>
#include <fstream>
#include <system_error>

namespace pleinair::hal::v4l2 {
namespace {

namespace fs = std::filesystem;

class KernelNodes final : public DeviceNodes {
 public:
  std::vector<std::string> list(const std::string& folder) override {
    std::vector<std::string> names;
    std::error_code failure;
    for (fs::directory_iterator at(folder, failure), end; !failure && at != end;
         at.increment(failure)) {
      names.push_back(at->path().filename().string());
    }
    return names;
  }

  std::optional<std::string> target(const std::string& link) override {
    std::error_code failure;
    const fs::path path = fs::canonical(link, failure);
    return failure ? std::nullopt : std::optional(path.string());
  }

  std::optional<std::string> firstLine(const std::string& file) override {
    std::ifstream stream(file);
    std::string line;
    if (!std::getline(stream, line)) return std::nullopt;
    return line;
  }
};

}  // namespace

DeviceNodes& kernelNodes() {
  static KernelNodes nodes;
  return nodes;
}

}  // namespace pleinair::hal::v4l2
