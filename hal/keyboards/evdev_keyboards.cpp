#include <array>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <libevdev/libevdev.h>

#include "hal/file_descriptor.h"
#include "hal/keyboards/buttons.h"
#include "hal/keyboards/evdev_listing.h"
#include "hal/keyboards/keyboard_device.h"

namespace pleinair::hal {
namespace {

struct LibevdevRelease {
  void operator()(libevdev* device) const { libevdev_free(device); }
};

class EvdevKeyboard final : public KeyboardDevice {
 public:
  EvdevKeyboard(std::string node, FileDescriptor file, libevdev* device)
      : node_(std::move(node)), file_(std::move(file)), device_(device) {}

  Answer read(KeyEvent& event) override {
    for (;;) {
      if (queued_) {
        event = *std::exchange(queued_, std::nullopt);
        return true;
      }
      input_event raw{};
      const int status = libevdev_next_event(
          device_.get(), isSyncing_ ? LIBEVDEV_READ_FLAG_SYNC : LIBEVDEV_READ_FLAG_NORMAL, &raw);
      if (status == -EAGAIN) {
        // While syncing: all differences have been told.
        if (!std::exchange(isSyncing_, false)) return false;
        continue;
      }
      if (status == -EINTR) continue;
      if (status < 0) return tl::unexpected(failed("cannot read", -status));
      if (status == LIBEVDEV_READ_STATUS_SYNC) isSyncing_ = true;
      if (raw.type == EV_ABS && turnHat(raw, event)) return true;
      if (raw.type != EV_KEY) continue;
      event = {.code = raw.code, .value = raw.value};
      return true;
    }
  }

  Result<void> setGrabbed(bool on) override {
    const int status = libevdev_grab(device_.get(), on ? LIBEVDEV_GRAB : LIBEVDEV_UNGRAB);
    if (status == 0) return {};
    return tl::unexpected(failed(on ? "cannot be had alone" : "cannot be let go", -status,
                                 status == -EBUSY ? "another program has grabbed it" : ""));
  }

 private:
  /// A gamepad's hat as the buttons of its directions, BTN_DPAD_…: many gamepads have no such
  /// buttons. Returns whether there is an event.
  bool turnHat(const input_event& raw, KeyEvent& event) {
    static constexpr std::array<std::array<unsigned, 2>, 2> kDirections{
        {{BTN_DPAD_LEFT, BTN_DPAD_RIGHT}, {BTN_DPAD_UP, BTN_DPAD_DOWN}}};
    if (raw.code != ABS_HAT0X && raw.code != ABS_HAT0Y) return false;
    const std::size_t axis = raw.code - ABS_HAT0X;
    const unsigned now = raw.value == 0 ? 0 : kDirections.at(axis).at(raw.value < 0 ? 0 : 1);
    const unsigned before = std::exchange(hat_.at(axis), now);
    if (now == before) return false;
    event = before != 0 ? KeyEvent{.code = before, .value = 0} : KeyEvent{.code = now, .value = 1};
    if (before != 0 && now != 0) queued_ = KeyEvent{.code = now, .value = 1};
    return true;
  }

  Error failed(std::string problem, int errnoValue, std::string remedy = {}) const {
    Error error = errnoError(node_, std::move(problem), errnoValue, std::move(remedy));
    if (errnoValue == ENODEV) error.kind = ErrorKind::kDeviceLost;
    return error;
  }

  std::string node_;
  FileDescriptor file_;  // before the device, which uses it
  std::unique_ptr<libevdev, LibevdevRelease> device_;
  bool isSyncing_ = false;         ///< the kernel's buffer overran (SYN_DROPPED)
  std::array<unsigned, 2> hat_{};  ///< held directions of the hat, 0: none
  std::optional<KeyEvent> queued_;
};

class EvdevKeyboards final : public KeyboardDevices {
 public:
  std::vector<KeyboardDescription> list() override { return listEvdevKeyboards(); }

  std::string nodeOf(const std::string& path) override {
    std::error_code failure;
    const std::filesystem::path node = std::filesystem::canonical(path, failure);
    return failure ? path : node.string();
  }

  Result<std::unique_ptr<KeyboardDevice>> open(const std::string& node) override {
    // To write is needed for lights only; a grab does without.
    FileDescriptor file(::open(node.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
    if (!file) {
      return tl::unexpected(errnoError(node, "cannot open", errno,
                                       errno == EACCES ? "add yourself to the group input" : ""));
    }
    libevdev* device = nullptr;
    const int status = libevdev_new_from_fd(file.get(), &device);
    if (status < 0) return tl::unexpected(errnoError(node, "is no input device", -status));
    return std::make_unique<EvdevKeyboard>(node, std::move(file), device);
  }
};

}  // namespace

KeyboardDevices& kernelKeyboards() {
  static EvdevKeyboards keyboards;
  return keyboards;
}

std::string buttonName(unsigned code) {
  const char* name = libevdev_event_code_get_name(EV_KEY, code);
  return name == nullptr ? std::to_string(code) : name;
}

std::optional<unsigned> buttonNamed(const std::string& name) {
  const int code = libevdev_event_code_from_name(EV_KEY, name.c_str());
  return code < 0 ? buttonNumbered(name) : std::optional(static_cast<unsigned>(code));
}

}  // namespace pleinair::hal
