// Discovery, by libcamera: 0.0.3 (Debian 12) to 0.7. This file and lc_*.cpp are the only ones that
// call it, with checks of its version where its interface has changed.

#include <cctype>
#include <cerrno>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hal/cameras/libcamera/lc_device.h"
#include "hal/cameras/libcamera/lc_manager.h"
#include "hal/cameras/libcamera/library.h"

namespace pleinair::hal::libcamera {
namespace {

/// Ids of the UVC pipeline handler end in "-VVVV:PPPP", vendor and product of the USB device.
bool endsInUsbIds(const std::string& id) {
  constexpr std::size_t kLength = 10;
  if (id.size() < kLength) return false;
  const std::string tail = id.substr(id.size() - kLength);
  for (std::size_t i = 0; i < kLength; ++i) {
    const auto letter = static_cast<unsigned char>(tail[i]);
    if (i == 0 ? letter != '-' : i == 5 ? letter != ':' : std::isxdigit(letter) == 0) return false;
  }
  return true;
}

class SystemLibrary final : public Library {
 public:
  Result<std::vector<FoundCamera>> list() override {
    const auto manager = Manager::shared();
    if (!manager) return tl::unexpected(manager.error());
    std::vector<FoundCamera> found;
    for (const auto& camera : (*manager)->cameras()) {
      found.push_back(
          {.id = camera->id(), .model = modelOf(*camera), .isUsb = endsInUsbIds(camera->id())});
    }
    return found;
  }

  Result<std::unique_ptr<Device>> open(const std::string& id) override {
    const auto manager = Manager::shared();
    if (!manager) return tl::unexpected(manager.error());
    std::shared_ptr<lc::Camera> camera = (*manager)->get(id);
    if (!camera) {
      return tl::unexpected(
          Error{.kind = ErrorKind::kNotFound,
                .problem = "is not there",
                .remedy = "`pleinair devices` lists those that are; check its cable"});
    }
    if (const int answer = camera->acquire(); answer < 0) {
      Error error = errnoError({}, "cannot be taken", -answer);
      if (answer == -EBUSY) error.remedy = "end the program that uses it";
      return tl::unexpected(std::move(error));
    }
    return lcDevice(*manager, std::move(camera));
  }
};

}  // namespace

Library& systemLibrary() {
  static SystemLibrary library;
  return library;
}

bool hasSystemLibrary() {
  return true;
}

}  // namespace pleinair::hal::libcamera
