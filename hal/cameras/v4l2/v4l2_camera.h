#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "hal/camera.h"
#include "hal/cameras/v4l2/controls.h"
#include "hal/cameras/v4l2/device_nodes.h"
#include "hal/frame_memory/allocators.h"

namespace pleinair::hal::v4l2 {

class Session;

/// What [camera.v4l2] sets.
struct V4l2Options {
  /// Whose memory frames lie in; unset: the device's own.
  std::optional<AllocatorKind> allocator;
  std::optional<PowerLine> powerLine;  ///< unset: as the device has it
};

/// A V4L2 device (docs/cameras.md): memory-mapped buffers, exported as dma-bufs if the driver can
/// do that, or memory of an allocator (StreamRequest::allocator, else that of the options) if the
/// driver takes it, over the single- or the multi-planar interface.
///
/// start() selects the mode nearest to the request (hal/cameras/v4l2/modes.h), reads back the
/// format that the driver set, and sets the controls (StreamFormat::warning tells where the driver
/// keeps another value). Its errors are those of Camera::start(); kNotFound names the available
/// cameras.
///
/// Frames lend the driver's buffers. If one more lease would leave the driver without a buffer, the
/// frame is copied instead: a consumer that holds frames costs time, but never stops the stream.
/// JPEGs are decoded within next(), to I420. A frame that is kIncomplete or kCorrupt shows the
/// buffer's previous content in its missing part; a JPEG shows the last valid image.
///
/// next() answers CameraLost after ENODEV, ENXIO, EIO, EINVAL and EBADF (which drivers answer once
/// they are unplugged or hang), and Error after any other error. It answers FormatChanged after a
/// change of the device's source (V4L2_EVENT_SOURCE_CHANGE), when it has negotiated and started
/// again.
class V4l2Camera final : public Camera {
 public:
  /// `id`: as V4l2Backend::list() gives it, or a node's path. No device is opened before start().
  V4l2Camera(const std::string& id, System system, Clock& clock, V4l2Options options = {});
  ~V4l2Camera() override;
  V4l2Camera(const V4l2Camera&) = delete;
  V4l2Camera& operator=(const V4l2Camera&) = delete;

  CameraIdentity identity() const override;
  Result<StreamFormat> start(const StreamRequest& request) override;
  NextFrame next(TimePoint deadline) override;
  void stop() override;

 private:
  System system_;
  Clock& clock_;
  V4l2Options options_;
  CameraIdentity identity_;
  std::unique_ptr<Session> session_;  ///< while streaming
};

}  // namespace pleinair::hal::v4l2
