#include "hal/cameras/v4l2/find_device.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include <linux/videodev2.h>

#include "hal/cameras/v4l2/device.h"
#include "hal/cameras/v4l2/modes.h"
#include "hal/v4l2/capability.h"
#include "hal/v4l2/written_nodes.h"

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

std::string baseName(const std::string& path) {
  return path.substr(path.rfind('/') + 1);
}

/// udev's ID_PATH of a node, "pci-0000:00:14.0-usb-0:4:1.0", as its rule 60-persistent-v4l and its
/// builtin path_id derive it from sysfs; empty where the kernel does not tell.
std::string pathIdOf(DeviceNodes& nodes, const std::string& name) {
  std::string id;
  std::string skipped;  // of parents that belong to the same bus, only the lowest is named
  std::string folder = nodes.target(sysfsOf(name) + "/device").value_or("");
  for (; folder.size() > 1; folder.resize(folder.rfind('/'))) {
    const std::string bus = baseName(nodes.target(folder + "/subsystem").value_or(""));
    if (bus == skipped) continue;
    const std::string device = baseName(folder);
    std::string part;
    if (bus == "usb") {
      part = "usb-0:" + device.substr(device.find('-') + 1);
    } else if (bus == "pci" || bus == "platform") {
      part = bus + "-" + device;
    } else {
      continue;
    }
    skipped = bus;
    id = id.empty() ? part : part + "-" + id;
  }
  return id;
}

std::string indexOf(DeviceNodes& nodes, const std::string& name) {
  return "-video-index" + nodes.firstLine(sysfsOf(name) + "/index").value_or("0");
}

/// The name of the link that udev makes, or is about to make, in /dev/v4l/by-path; or empty.
std::string byPathName(DeviceNodes& nodes, const std::string& name) {
  const std::string id = pathIdOf(nodes, name);
  return id.empty() ? id : id + indexOf(nodes, name);
}

/// The name of the link in /dev/v4l/by-id of a USB device; or empty.
std::string byIdName(DeviceNodes& nodes, const std::string& name) {
  const auto text = [&](const char* file) {
    return nodes.firstLine(sysfsOf(name) + "/device/../" + file).value_or("");
  };
  const auto either = [&](const char* file, const char* otherwise) {
    const std::string found = text(file);
    return found.empty() ? text(otherwise) : found;
  };
  const std::string vendor = either("manufacturer", "idVendor");
  const std::string model = either("product", "idProduct");
  if (vendor.empty() || model.empty()) return {};
  const std::string serial = text("serial");
  return plainText("usb-" + vendor + "_" + model + (serial.empty() ? "" : "_" + serial)) +
         indexOf(nodes, name);
}

/// Whether a link cannot be this node's, for the kernel says that it is another device's.
bool contradictsPath(DeviceNodes& nodes, const std::string& link, const std::string& name) {
  const std::string own = byPathName(nodes, name);
  // The same device has a second link, whose name tells the version of USB.
  return !own.empty() && link != own && link.find("usbv") == std::string::npos;
}
bool contradictsId(DeviceNodes& nodes, const std::string& link, const std::string& name) {
  const auto serial = nodes.firstLine(sysfsOf(name) + "/device/../serial");
  return serial && !serial->empty() && link.find(plainText(*serial)) == std::string::npos;
}

/// One look at /dev, which gives each node its id.
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
    if (isWritten(node)) return std::nullopt;  // its picture is the program's own
    const Result<Device> device = Device::open(system_.calls, node);
    if (!device && device.error().kind == ErrorKind::kUnsupported) return std::nullopt;
    // One end of a pipeline that the media controller sets up: libcamera has its sensors.
    if (device && device->capability().has(V4L2_CAP_IO_MC)) return std::nullopt;
    CameraDescription camera{.identity = {.backend = "v4l2"},
                             .serial = serialOf(name),
                             .path = byPathName(system_.nodes, name),
                             .node = node};
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
    for (auto [link, end] = byId_.equal_range(node); link != end; ++link) {
      if (!contradictsId(system_.nodes, link->second, name)) return link->second;
    }
    for (auto [link, end] = byPath_.equal_range(node); link != end; ++link) {
      if (!contradictsPath(system_.nodes, link->second, name)) return link->second;
    }
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

/// The one node that the kernel describes as udev's link of this name; nothing where there is none,
/// or where several are alike.
std::optional<std::string> nodeBySysfs(DeviceNodes& nodes, const std::string& id) {
  std::optional<std::string> found;
  for (const std::string& name : nodeNames(nodes)) {
    if (byPathName(nodes, name) != id && byIdName(nodes, name) != id) continue;
    if (found) return std::nullopt;
    found = "/dev/" + name;
  }
  return found;
}

/// Where udev's link of this name leads, unless it is stale.
std::optional<std::string> nodeByLink(DeviceNodes& nodes, const std::string& id) {
  auto node = nodes.target(std::string(kById) + "/" + id);
  if (node && !contradictsId(nodes, id, baseName(*node))) return node;
  node = nodes.target(std::string(kByPath) + "/" + id);
  if (node && !contradictsPath(nodes, id, baseName(*node))) return node;
  return std::nullopt;
}

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
  if (auto node = nodeBySysfs(system.nodes, id)) return *std::move(node);
  if (auto node = nodeByLink(system.nodes, id)) return *std::move(node);
  const std::vector<CameraDescription> cameras = listDevices(system);
  const auto found = std::ranges::find(
      cameras, id, [](const CameraDescription& camera) { return camera.identity.id; });
  if (found == cameras.end()) return tl::unexpected(notThere(id, cameras));
  return found->node;
}

}  // namespace pleinair::hal::v4l2
