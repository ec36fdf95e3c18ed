#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "hal/camera.h"
#include "hal/cameras/v4l2/device_nodes.h"

namespace pleinair::hal::v4l2 {

class Session;

/// A V4L2 device (docs/cameras.md): memory-mapped buffers, exported as dma-bufs where the driver
/// does that, over the single- or the multi-planar interface.
///
/// start() takes the mode that comes nearest to the request (hal/cameras/v4l2/modes.h), reads back
/// what the driver made of it, and sets the controls. Its errors are Camera's; besides, kNotFound
/// names the cameras that there are.
///
/// Frames lend the driver's buffers. Where a frame more would leave the driver with none, it is
/// copied instead, so that a consumer that holds on to frames costs time and not the stream. JPEGs
/// are decoded within next(), to I420. Of a frame that is kIncomplete or kCorrupt the rest of the
/// picture is what the buffer held before, and of a JPEG the last sound picture.
///
/// next() answers CameraLost after ENODEV, ENXIO, EIO, EINVAL and EBADF (what drivers say once they
/// are unplugged or wedged), and Error after anything else; FormatChanged when the device's source
/// has changed (V4L2_EVENT_SOURCE_CHANGE), having negotiated and started anew.
class V4l2Camera final : public Camera {
 public:
  /// `id`: as V4l2Backend::list() gives it, or a node's path. Nothing is opened before start().
  V4l2Camera(std::string id, System system, Clock& clock);
  ~V4l2Camera() override;

  CameraIdentity identity() const override;
  Result<StreamFormat> start(const StreamRequest& request) override;
  NextFrame next(TimePoint deadline) override;
  void stop() override;

 private:
  System system_;
  Clock& clock_;
  CameraIdentity identity_;
  std::unique_ptr<Session> session_;  ///< while streaming
};

}  // namespace pleinair::hal::v4l2
