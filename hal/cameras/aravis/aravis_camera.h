#pragma once

#include <memory>
#include <string>

#include "hal/cameras/aravis/library.h"
#include "hal/cameras/aravis/setup.h"
#include "hal/cameras/session_camera.h"

namespace pleinair::hal::aravis {

/// A GigE Vision or USB3 Vision camera (docs/cameras.md), by way of Aravis.
///
/// start() opens the device, sets it up (setup.h) and reads back what it does. Errors: those of
/// Camera::start(); kBusy also if another program controls the device.
///
/// Frames of 8 bits lend the buffers that packets are put together in; 12-bit formats are unpacked
/// to 8 bits into images of the camera's own. If a lease would leave Aravis with fewer than two
/// buffers, the frame is copied instead. A frame that lacks packets is kIncomplete and shows the
/// buffer's previous content there.
///
/// next() answers CameraLost once Aravis has had no answer of the device for some seconds, or it is
/// unplugged. stop() may block for as long as the device does not answer, 7.5 s at most: devices
/// run on driver threads, which the program abandons after 1 s (hal/supervisor/worker_camera.h).
class AravisCamera final : public SessionCamera {
 public:
  /// `id`: FoundDevice::id, physical id or address. The library outlives the camera and its frames.
  AravisCamera(std::string id, AravisOptions options, Library& library, Clock& clock);

 private:
  Result<std::unique_ptr<CameraSession>> open() override;

  std::string id_;
  AravisOptions options_;
  Library& library_;
  Clock& clock_;
};

}  // namespace pleinair::hal::aravis
