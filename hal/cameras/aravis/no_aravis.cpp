// Replaces aravis_library.cpp in builds without libaravis.

#include "hal/cameras/aravis/library.h"

namespace pleinair::hal::aravis {
namespace {

class NoLibrary final : public Library {
 public:
  Result<std::vector<FoundDevice>> discover(bool, bool) override {
    return std::vector<FoundDevice>();
  }
  Result<std::unique_ptr<Device>> open(const std::string&) override {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .problem = "GigE Vision and USB3 Vision are not in this build",
                                .remedy = "install libaravis-dev and build anew"});
  }
  std::size_t grantedSocketBuffer(std::size_t bytes) override { return bytes; }
  bool mayUsePacketSocket() override { return false; }
};

}  // namespace

Library& systemLibrary() {
  static NoLibrary library;
  return library;
}

}  // namespace pleinair::hal::aravis
