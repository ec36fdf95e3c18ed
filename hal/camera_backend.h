#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/error.h"

namespace pleinair::hal {

/// One kind of frames that a device offers.
struct CameraMode {
  std::string layout;             ///< the device's own name of it: a fourcc such as "YUYV", "MJPG"
  FrameSize size;                 ///< the largest, where it takes a range
  std::vector<Duration> periods;  ///< shortest first; empty where it does not say
  bool isSupported = true;        ///< whether we read this layout
};

/// What a back end tells of a device without streaming from it.
struct CameraDescription {
  CameraIdentity identity;
  std::string serial;  ///< empty where it has none
  std::string node;    ///< "/dev/video0"; empty where it has none
  std::vector<CameraMode> modes;
  std::optional<Error> problem;  ///< why it could not be looked at (permissions, busy)
};

/// A family of cameras: finds those that are there, and makes them. One thread at a time.
class CameraBackend {
 public:
  virtual ~CameraBackend() = default;
  CameraBackend() = default;
  CameraBackend(const CameraBackend&) = delete;
  CameraBackend& operator=(const CameraBackend&) = delete;

  virtual std::string_view name() const = 0;  ///< "v4l2"

  /// What is there now, in an order that does not change while nothing is plugged. Errors: kIo.
  virtual Result<std::vector<CameraDescription>> list() = 0;

  /// The device of that identity().id, stopped; it need not be there (start() says so). The clock
  /// outlives the camera.
  virtual std::unique_ptr<Camera> make(const std::string& id, Clock& clock) = 0;
};

}  // namespace pleinair::hal
