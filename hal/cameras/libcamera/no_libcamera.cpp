// Replaces libcamera_library.cpp in builds without libcamera.

#include "hal/cameras/libcamera/library.h"

namespace pleinair::hal::libcamera {
namespace {

class NoLibrary final : public Library {
 public:
  Result<std::vector<FoundCamera>> list() override { return std::vector<FoundCamera>(); }
  Result<std::unique_ptr<Device>> open(const std::string&) override {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .problem = "libcamera is not in this build",
                                .remedy = "install libcamera-dev and build anew"});
  }
};

}  // namespace

Library& systemLibrary() {
  static NoLibrary library;
  return library;
}

bool hasSystemLibrary() {
  return false;
}

}  // namespace pleinair::hal::libcamera
