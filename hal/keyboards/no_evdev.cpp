// Replaces evdev_keyboards.cpp in builds without libevdev.

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

}  // namespace pleinair::hal
