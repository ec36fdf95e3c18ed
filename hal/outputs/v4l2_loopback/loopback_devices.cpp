#include "hal/outputs/v4l2_loopback/loopback_devices.h"

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <linux/videodev2.h>

#include "hal/file_descriptor.h"
#include "hal/v4l2/capability.h"
#include "hal/v4l2/formats.h"

namespace pleinair::hal {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kLoopbackDriver = "v4l2 loopback";
constexpr __u32 kMaxLayouts = 256;  // a driver that never ends its list

/// "video0", "video1" … in `folder`, by number. Nothing where there is no such folder.
std::vector<fs::path> videoNodes(const fs::path& folder) {
  std::vector<std::pair<int, fs::path>> nodes;
  std::error_code failure;
  for (fs::directory_iterator each(folder, failure), end; !failure && each != end;
       each.increment(failure)) {
    const auto number = v4l2::videoNumber(each->path().filename().string());
    if (number) nodes.emplace_back(*number, each->path());
  }
  std::ranges::sort(nodes);
  std::vector<fs::path> paths;
  paths.reserve(nodes.size());
  for (auto& node : nodes) paths.push_back(std::move(node.second));
  return paths;
}

std::vector<std::string> layoutsOf(v4l2::SystemCalls& calls, int fd) {
  std::vector<std::string> layouts;
  for (__u32 i = 0; i < kMaxLayouts; ++i) {
    v4l2_fmtdesc entry{};
    entry.index = i;
    entry.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    if (calls.ioctl(fd, VIDIOC_ENUM_FMT, &entry) < 0) break;
    layouts.push_back(v4l2::fourccText(entry.pixelformat));
  }
  return layouts;
}

LoopbackDevice inspect(const std::string& node, v4l2::SystemCalls& calls) {
  LoopbackDevice device{.node = node};
  const int opened = calls.open(node.c_str(), O_RDWR | O_NONBLOCK);
  if (opened < 0) {
    device.problem = errnoError(node, "cannot open", -opened);
    return device;
  }
  const FileDescriptor descriptor(opened, calls);
  const Result<v4l2::Capability> capability = v4l2::queryCapability(calls, opened, node);
  if (!capability) {
    device.problem = capability.error();
    return device;
  }
  device.card = capability->card;
  device.driver = capability->driver;
  device.isLoopback = capability->driver == kLoopbackDriver;
  device.isWritable = capability->outputsVideo();
  device.isReadable = capability->capturesVideo();
  if (device.isWritable) device.layouts = layoutsOf(calls, opened);
  return device;
}

std::string listText(const std::vector<LoopbackDevice>& devices) {
  std::string text;
  for (const LoopbackDevice& device : devices) {
    if (device.problem) continue;
    text += (text.empty() ? "" : ", ") + device.node + " (" + device.card + ")";
  }
  return text;
}

Error notFound(const std::string& name, const std::vector<LoopbackDevice>& devices) {
  const auto refused = std::ranges::find_if(devices, [](const LoopbackDevice& device) {
    return device.problem && device.problem->kind == ErrorKind::kPermissionDenied;
  });
  if (refused != devices.end()) {
    Error error = *refused->problem;
    error.remedy = kJoinVideo;
    return error;
  }
  const std::string there = listText(devices);
  return {.kind = ErrorKind::kNotFound,
          .subject = name.empty() ? "loopback" : "loopback:" + name,
          .problem = there.empty()  ? "there is no v4l2loopback device"
                     : name.empty() ? "there is no v4l2loopback device, only " + there
                                    : "no device has this label; there are " + there,
          .remedy = there.empty() || name.empty()
                        ? std::string(kLoadLoopback)
                        : "give one of these labels, or a node as loopback:/dev/video50"};
}

std::string remedyOfOpening(int errnoValue) {
  switch (errnoValue) {
    case ENOENT:
    case ENXIO:
    case ENODEV:
      return kLoadLoopback;
    case EACCES:
    case EPERM:
      return kJoinVideo;
    case EBUSY:
      return "too many programs have it open: end one, or raise v4l2loopback's max_openers";
    default:
      return {};
  }
}

}  // namespace

Error loopbackInUse(const std::string& node) {
  return {
      .kind = ErrorKind::kBusy,
      .subject = node,
      .problem = "takes no pictures now: another program writes to it, or one did and left it so",
      .remedy = "end that program, or load the module again: sudo modprobe -r v4l2loopback && " +
                std::string(kLoadLoopback)};
}

std::vector<LoopbackDevice> listLoopbacks(const V4l2System& system) {
  std::vector<LoopbackDevice> devices;
  for (const fs::path& node : videoNodes(system.nodes)) {
    LoopbackDevice device = inspect(node.string(), *system.calls);
    const bool isGone = device.problem && device.problem->kind == ErrorKind::kNotFound;
    const bool matters = device.problem || device.isLoopback || device.isWritable;
    if (matters && !isGone) devices.push_back(std::move(device));
  }
  return devices;
}

Result<std::string> findLoopback(const std::string& name, const V4l2System& system) {
  if (name.starts_with('/')) return name;
  const std::vector<LoopbackDevice> devices = listLoopbacks(system);
  const LoopbackDevice* taken = nullptr;
  for (const LoopbackDevice& device : devices) {
    const bool matches = name.empty() ? device.isLoopback : device.card == name;
    if (device.problem || !matches) continue;
    if (device.isWritable) return device.node;
    if (taken == nullptr) taken = &device;
  }
  return tl::unexpected(taken != nullptr ? loopbackInUse(taken->node) : notFound(name, devices));
}

Result<OpenLoopback> openLoopbackNode(const std::string& name, const V4l2System& system) {
  Result<std::string> node = findLoopback(name, system);
  if (!node) return tl::unexpected(std::move(node.error()));
  const int opened = system.calls->open(node->c_str(), O_RDWR | O_NONBLOCK);
  if (opened < 0) {
    return tl::unexpected(errnoError(*node, "cannot open", -opened, remedyOfOpening(-opened)));
  }
  FileDescriptor descriptor(opened, *system.calls);
  const Result<v4l2::Capability> capability = v4l2::queryCapability(*system.calls, opened, *node);
  if (!capability) return tl::unexpected(capability.error());
  if (capability->has(V4L2_CAP_VIDEO_OUTPUT) && capability->has(V4L2_CAP_READWRITE)) {
    return OpenLoopback{.node = *std::move(node), .descriptor = std::move(descriptor)};
  }
  if (capability->driver == kLoopbackDriver) return tl::unexpected(loopbackInUse(*node));
  return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                              .subject = *node,
                              .problem = "(" + capability->card + ") takes no pictures by write()",
                              .remedy = "give a loopback's node; `pleinair devices` lists them"});
}

}  // namespace pleinair::hal
