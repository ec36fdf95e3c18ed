#include "hal/cameras/v4l2/device.h"

#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <linux/videodev2.h>

namespace pleinair::hal::v4l2 {
namespace {

Error unsupported(const std::string& node, std::string problem, std::string remedy) {
  return {.kind = ErrorKind::kUnsupported,
          .subject = node,
          .problem = std::move(problem),
          .remedy = std::move(remedy)};
}

std::string remedyOf(int answer, const std::string& node) {
  switch (answer) {
    case -EACCES:
    case -EPERM:
      return "join the group that owns it (usually: sudo usermod -aG video $USER, then log in "
             "again)";
    case -EBUSY:
      return "end the program that uses it (fuser -v " + node + ")";
    case -ENOENT:
    case -ENODEV:
    case -ENXIO:
      return "plug the camera in";
    default:
      return {};
  }
}

}  // namespace

Device::Device(SystemCalls& calls, std::string node, FileDescriptor descriptor,
               Capability capability)
    : calls_(&calls),
      node_(std::move(node)),
      descriptor_(std::move(descriptor)),
      capability_(std::move(capability)) {}

Result<Device> Device::open(SystemCalls& calls, const std::string& node) {
  const int fd = calls.open(node.c_str(), O_RDWR | O_NONBLOCK);
  if (fd < 0) {
    return tl::unexpected(errnoError(node, "cannot open", -fd, remedyOf(fd, node)));
  }
  FileDescriptor descriptor(fd, calls);
  Result<Capability> capability = queryCapability(calls, fd, node);
  if (!capability) return tl::unexpected(std::move(capability.error()));
  if (!capability->capturesVideo()) {
    return tl::unexpected(unsupported(node, "captures no video (" + capability->card + ")",
                                      "choose another node, or start its source"));
  }
  if (!capability->has(V4L2_CAP_STREAMING)) {
    return tl::unexpected(unsupported(node, "has no streaming I/O (" + capability->card + ")",
                                      "choose another camera"));
  }
  return Device(calls, node, std::move(descriptor), *std::move(capability));
}

bool Device::isMultiPlanar() const {
  return !capability_.has(V4L2_CAP_VIDEO_CAPTURE);
}

std::uint32_t Device::bufferType() const {
  return isMultiPlanar() ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
}

Error Device::failure(std::string problem, int answer) const {
  return errnoError(node_, std::move(problem), -answer, remedyOf(answer, node_));
}

bool meansLost(int answer) {
  return answer == -ENODEV || answer == -ENXIO || answer == -EIO || answer == -EINVAL ||
         answer == -EBADF;
}

}  // namespace pleinair::hal::v4l2
