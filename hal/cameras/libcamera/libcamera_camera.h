#pragma once

#include <memory>
#include <string>

#include "hal/cameras/libcamera/library.h"
#include "hal/cameras/session_camera.h"

namespace pleinair::hal::libcamera {

/// What [camera.libcamera] sets.
struct LibcameraOptions {
  Orientation orientation = Orientation::kUpright;
  int buffers = 6;
  bool makesLuma = true;  ///< StreamRequest::lumaSidePx is followed
};

/// A camera by way of libcamera (docs/cameras.md): sensors whose image processor libcamera drives.
///
/// start() opens the camera, asks for the format nearest to the request (frame_layout.h), reads
/// back what libcamera made of it, and sets the controls. Errors: those of Camera::start();
/// kUnsupported names what the camera has.
///
/// Frames lend libcamera's buffers, with their dma-bufs; formats of blue, green, red order are
/// copied to RGB8. If a lease would leave libcamera with fewer than two buffers, the frame is
/// copied instead.
///
/// next() answers CameraLost once libcamera says that the camera was unplugged. It does not say so
/// in every case, nor of any error of the driver: then it answers CameraTimeout, and the
/// supervisor's watchdog finds out. stop() may block while a driver hangs: devices run on driver
/// threads (hal/supervisor/worker_camera.h).
class LibcameraCamera final : public SessionCamera {
 public:
  /// The library outlives the camera and its frames.
  LibcameraCamera(std::string id, LibcameraOptions options, Library& library, Clock& clock);

 private:
  Result<std::unique_ptr<CameraSession>> open() override;

  std::string id_;
  LibcameraOptions options_;
  Library& library_;
  Clock& clock_;
};

}  // namespace pleinair::hal::libcamera
