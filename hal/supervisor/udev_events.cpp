#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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

/// udev sets the name and the permissions of a node within this.
constexpr int kSettlingMilliseconds = 500;

class UdevEvents final : public DeviceEvents {
 public:
  Result<void> open() {
    context_.reset(udev_new());
    if (!context_) return tl::unexpected(failed("cannot open", ENOMEM));
    for (auto [monitor, group] : {std::pair(&udev_, "udev"), std::pair(&kernel_, "kernel")}) {
      if (const Result<void> listening = listen(*monitor, group); !listening) return listening;
    }
    return {};
  }

  Result<DeviceEvent> next() override {
    std::array<pollfd, 3> sources{
        pollfd{.fd = udev_monitor_get_fd(udev_.get()), .events = POLLIN, .revents = 0},
        pollfd{.fd = udev_monitor_get_fd(kernel_.get()), .events = POLLIN, .revents = 0},
        pollfd{.fd = interrupted_.get(), .events = POLLIN, .revents = 0}};
    for (;;) {
      const int count = poll(sources.data(), sources.size(), unsettled_.empty() ? -1 : settling());
      if (count < 0) {
        if (errno == EINTR) continue;
        return tl::unexpected(failed("cannot wait", errno));
      }
      if (sources[2].revents != 0) {
        return tl::unexpected(
            Error{.kind = ErrorKind::kNotFound, .subject = "udev", .problem = "was interrupted"});
      }
      if (count == 0) return settled();
      for (udev_monitor* each : {udev_.get(), kernel_.get()}) {
        const short events = sources.at(each == udev_.get() ? 0 : 1).revents;
        if (events == 0) continue;
        if ((events & POLLIN) == 0) return tl::unexpected(failed("cannot wait", EIO));
        const auto event = received(each);
        if (!event) continue;  // filtered out, or the socket's buffer overran
        if (each == kernel_.get()) settleLater(*event);
        return *event;
      }
    }
  }

  void interrupt() override {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = write(interrupted_.get(), &one, sizeof one);
  }

 private:
  using Clock = std::chrono::steady_clock;

  Result<void> listen(UdevHandle<udev_monitor>& monitor, const char* group) {
    monitor.reset(udev_monitor_new_from_netlink(context_.get(), group));
    if (!monitor || !interrupted_) return tl::unexpected(failed("cannot listen", errno));
    for (const char* subsystem : {"video4linux", "usb", "drm", "input"}) {
      const int error =
          udev_monitor_filter_add_match_subsystem_devtype(monitor.get(), subsystem, nullptr);
      if (error < 0) return tl::unexpected(failed("cannot choose among events", -error));
    }
    const int error = udev_monitor_enable_receiving(monitor.get());
    if (error < 0) return tl::unexpected(failed("cannot listen", -error));
    return {};
  }

  static std::optional<DeviceEvent> received(udev_monitor* monitor) {
    const UdevHandle<udev_device> device(udev_monitor_receive_device(monitor));
    if (!device) return std::nullopt;
    return DeviceEvent{.action = textOf(udev_device_get_action(device.get())),
                       .subsystem = textOf(udev_device_get_subsystem(device.get())),
                       .node = textOf(udev_device_get_devnode(device.get()))};
  }

  /// The last event of each subsystem comes again.
  void settleLater(const DeviceEvent& event) {
    std::erase_if(unsettled_,
                  [&](const DeviceEvent& each) { return each.subsystem == event.subsystem; });
    unsettled_.push_back(event);
    settledAt_ = Clock::now() + std::chrono::milliseconds(kSettlingMilliseconds);
  }
  int settling() const {
    const auto rest = std::chrono::ceil<std::chrono::milliseconds>(settledAt_ - Clock::now());
    return static_cast<int>(std::clamp<std::int64_t>(rest.count(), 0, kSettlingMilliseconds));
  }
  DeviceEvent settled() {
    DeviceEvent event = std::move(unsettled_.front());
    unsettled_.erase(unsettled_.begin());
    return event;
  }

  UdevHandle<udev> context_;
  UdevHandle<udev_monitor> udev_;
  UdevHandle<udev_monitor> kernel_;
  std::vector<DeviceEvent> unsettled_;  ///< events of the kernel that come again
  Clock::time_point settledAt_;
  FileDescriptor interrupted_{eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
};

}  // namespace

Result<std::unique_ptr<DeviceEvents>> udevEvents() {
  auto events = std::make_unique<UdevEvents>();
  if (const Result<void> opened = events->open(); !opened) return tl::unexpected(opened.error());
  return events;
}

}  // namespace pleinair::hal
