#include "hal/cameras/v4l2/find_device.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "hal/cameras/v4l2/device.h"
#include "hal/cameras/v4l2/modes.h"
#include "hal/v4l2/capability.h"

namespace pleinair::hal::v4l2 {
namespace {

constexpr const char* kById = "/dev/v4l/by-id";
constexpr const char* kByPath = "/dev/v4l/by-path";

/// "video0", "video1" …, by number.
std::vector<std::string> nodeNames(DeviceNodes& nodes) {
  std::vector<std::string> names = nodes.list("/dev");
  std::erase_if(names, [](const std::string& name) { return !videoNumber(name); });
  std::ranges::sort(names, {}, [](const std::string& name) { return *videoNumber(name); });
  return names;
}

/// Maps each device node to the names of a folder's links to it.
std::multimap<std::string, std::string> linksByNode(DeviceNodes& nodes, const std::string& folder) {
  std::vector<std::string> names = nodes.list(folder);
  std::ranges::sort(names);
  std::multimap<std::string, std::string> links;
  for (const std::string& name : names) {
    if (const auto node = nodes.target(folder + "/" + name)) links.emplace(*node, name);
  }
  return links;
}

std::string sysfsOf(const std::string& name) {
  return "/sys/class/video4linux/" + name;
}

/// The text without characters that shells and TOML would require to be quoted.
std::string plainText(std::string text) {
  const auto isPlain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == ':' || c == '-' || c == '_';
  };
  std::ranges::replace_if(
      text, [&](char c) { return !isPlain(c); }, '_');
  return text;
}

/// A snapshot of /dev that gives each node its id.
class Listing {
 public:
  explicit Listing(const System& system)
      : system_(system),
        byId_(linksByNode(system.nodes, kById)),
        byPath_(linksByNode(system.nodes, kByPath)) {}

  std::vector<CameraDescription> cameras() {
    std::vector<CameraDescription> found;
    for (const std::string& name : nodeNames(system_.nodes)) {
      if (auto camera = describe(name)) found.push_back(*std::move(camera));
    }
    return found;
  }

 private:
  std::optional<CameraDescription> describe(const std::string& name) {
    const std::string node = "/dev/" + name;
    const Result<Device> device = Device::open(system_.calls, node);
    if (!device && device.error().kind == ErrorKind::kUnsupported) return std::nullopt;
    CameraDescription camera{
        .identity = {.backend = "v4l2"}, .serial = serialOf(name), .node = node};
    const std::string card =
        device ? device->capability().card
               : system_.nodes.firstLine(sysfsOf(name) + "/name").value_or("V4L2 device");
    camera.identity.description = card;
    camera.identity.id = idOf(name, node, device ? &device->capability() : nullptr);
    if (!device) {
      camera.problem = device.error();
      return camera;
    }
    // A loopback device whose output and capture sides share a node is a camera only while it is
    // fed.
    const bool hasFormats = !enumerateFormats(*device).empty();
    if (!hasFormats && device->capability().outputsVideo()) return std::nullopt;
    camera.modes = modesOf(*device);
    return camera;
  }

  std::string idOf(const std::string& name, const std::string& node, const Capability* capability) {
    if (const auto link = byId_.find(node); link != byId_.end()) return link->second;
    if (const auto link = byPath_.find(node); link != byPath_.end()) return link->second;
    if (capability == nullptr) return node;
    const std::string index = system_.nodes.firstLine(sysfsOf(name) + "/index").value_or("0");
    const std::string id = plainText(capability->bus + "-" + capability->card + "-index" + index);
    return taken_.insert({id, node}).second ? id : node;
  }

  /// The serial number of a USB device. The node's device is an interface of it.
  std::string serialOf(const std::string& name) {
    return system_.nodes.firstLine(sysfsOf(name) + "/device/../serial").value_or("");
  }

  const System& system_;
  std::multimap<std::string, std::string> byId_, byPath_;
  std::map<std::string, std::string> taken_;
};

Error notThere(const std::string& id, const std::vector<CameraDescription>& cameras) {
  std::string there;
  for (const CameraDescription& camera : cameras) {
    there += (there.empty() ? "" : ", ") + camera.identity.id;
  }
  return {.kind = ErrorKind::kNotFound,
          .subject = id,
          .problem = "no V4L2 camera with this id is connected",
          .remedy = there.empty() ? "plug it in; no camera is connected"
                                  : "plug it in, or choose one of " + there};
}

}  // namespace

std::vector<CameraDescription> listDevices(const System& system) {
  return Listing(system).cameras();
}

Result<std::string> findNode(const System& system, const std::string& id) {
  if (id.starts_with('/')) return id;
  for (const char* folder : {kById, kByPath}) {
    if (auto node = system.nodes.target(std::string(folder) + "/" + id)) return *std::move(node);
  }
  const std::vector<CameraDescription> cameras = listDevices(system);
  const auto found = std::ranges::find(
      cameras, id, [](const CameraDescription& camera) { return camera.identity.id; });
  if (found == cameras.end()) return tl::unexpected(notThere(id, cameras));
  return found->node;
}

}  // namespace pleinair::hal::v4l2
