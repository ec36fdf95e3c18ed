#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hal/camera_backend.h"
#include "hal/camera_kind.h"
#include "hal/cameras/aravis/library.h"
#include "hal/cameras/aravis/setup.h"

namespace pleinair::hal::aravis {

/// Where cameras are looked for.
struct AravisDiscovery {
  bool gige = true;
  bool usb3 = true;
};

/// The GigE Vision and USB3 Vision cameras on the network and the bus. Ids: FoundDevice::id, or the
/// physical id where two devices have one id. make() also takes an IP address.
class AravisBackend final : public CameraBackend {
 public:
  explicit AravisBackend(AravisOptions options = {}, AravisDiscovery discovery = {},
                         Library& library = systemLibrary())
      : options_(std::move(options)), discovery_(discovery), library_(library) {}

  std::string_view name() const override { return "aravis"; }
  /// Waits 1 s for answers from the network.
  Result<std::vector<CameraDescription>> list() override;
  std::unique_ptr<Camera> make(const std::string& id, Clock& clock) override;
  /// At the device's current binning. Rates are found out by setting them only.
  Result<OfferedModes> offeredModes(const std::string& id, const StreamRequest& request) override;

 private:
  AravisOptions options_;
  AravisDiscovery discovery_;
  Library& library_;
};

/// Machine-vision cameras, with the keys of [camera.aravis].
const CameraKind& cameraKind();

}  // namespace pleinair::hal::aravis
