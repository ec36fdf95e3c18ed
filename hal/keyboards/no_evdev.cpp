// Replaces evdev_keyboards.cpp in builds without libevdev.

#include <optional>
#include <string>

#include "hal/keyboards/buttons.h"
#include "hal/keyboards/evdev_listing.h"
#include "hal/keyboards/keyboard_device.h"

namespace pleinair::hal {
namespace {

class NoKeyboards final : public KeyboardDevices {
 public:
  std::vector<KeyboardDescription> list() override { return listEvdevKeyboards(); }
  std::string nodeOf(const std::string& path) override { return path; }
  Result<std::unique_ptr<KeyboardDevice>> open(const std::string& node) override {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = node,
                                .problem = "keyboards are not in this build",
                                .remedy = "install libevdev-dev and build anew"});
  }
};

}  // namespace

KeyboardDevices& kernelKeyboards() {
  static NoKeyboards keyboards;
  return keyboards;
}

std::string buttonName(unsigned code) {
  return std::to_string(code);
}

std::optional<unsigned> buttonNamed(const std::string& name) {
  return buttonNumbered(name);
}

}  // namespace pleinair::hal
