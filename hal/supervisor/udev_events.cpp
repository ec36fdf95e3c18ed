#include <array>
#include <cerrno>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include <libudev.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "hal/file_descriptor.h"
#include "hal/supervisor/hotplug_monitor.h"

namespace pleinair::hal {
namespace {

struct UdevRelease {
  void operator()(udev* context) const { udev_unref(context); }
  void operator()(udev_monitor* monitor) const { udev_monitor_unref(monitor); }
  void operator()(udev_device* device) const { udev_device_unref(device); }
};
template <class T>
using UdevHandle = std::unique_ptr<T, UdevRelease>;

std::string textOf(const char* text) {
  return text == nullptr ? std::string() : std::string(text);
}

Error failed(std::string problem, int errnoValue) {
  return errnoError("udev", std::move(problem), errnoValue,
                    "devices that are plugged in are found again all the same, if later");
}

class UdevEvents final : public DeviceEvents {
 public:
  Result<void> open() {
    context_.reset(udev_new());
    if (!context_) return tl::unexpected(failed("cannot open", ENOMEM));
    // udev's events, not the kernel's, because only then the node has its name and permissions.
    monitor_.reset(udev_monitor_new_from_netlink(context_.get(), "udev"));
    if (!monitor_ || !interrupted_) return tl::unexpected(failed("cannot listen", errno));
    for (const char* subsystem : {"video4linux", "usb", "drm", "input"}) {
      const int error =
          udev_monitor_filter_add_match_subsystem_devtype(monitor_.get(), subsystem, nullptr);
      if (error < 0) return tl::unexpected(failed("cannot choose among events", -error));
    }
    const int error = udev_monitor_enable_receiving(monitor_.get());
    if (error < 0) return tl::unexpected(failed("cannot listen", -error));
    return {};
  }

  Result<DeviceEvent> next() override {
    std::array<pollfd, 2> sources{
        pollfd{.fd = udev_monitor_get_fd(monitor_.get()), .events = POLLIN, .revents = 0},
        pollfd{.fd = interrupted_.get(), .events = POLLIN, .revents = 0}};
    for (;;) {
      if (poll(sources.data(), sources.size(), -1) < 0) {
        if (errno == EINTR) continue;
        return tl::unexpected(failed("cannot wait", errno));
      }
      if (sources[1].revents != 0) {
        return tl::unexpected(
            Error{.kind = ErrorKind::kNotFound, .subject = "udev", .problem = "was interrupted"});
      }
      if ((sources[0].revents & POLLIN) == 0) return tl::unexpected(failed("cannot wait", EIO));
      const UdevHandle<udev_device> device(udev_monitor_receive_device(monitor_.get()));
      if (!device) continue;  // filtered out, or the socket's buffer overran
      return DeviceEvent{.action = textOf(udev_device_get_action(device.get())),
                         .subsystem = textOf(udev_device_get_subsystem(device.get())),
                         .node = textOf(udev_device_get_devnode(device.get()))};
    }
  }

  void interrupt() override {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = write(interrupted_.get(), &one, sizeof one);
  }

 private:
  UdevHandle<udev> context_;
  UdevHandle<udev_monitor> monitor_;
  FileDescriptor interrupted_{eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
};

}  // namespace

Result<std::unique_ptr<DeviceEvents>> udevEvents() {
  auto events = std::make_unique<UdevEvents>();
  if (const Result<void> opened = events->open(); !opened) return tl::unexpected(opened.error());
  return events;
}

}  // namespace pleinair::hal
