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

/// A stream mode that a device offers.
struct CameraMode {
  std::string layout;  ///< the device's name of the pixel layout: a fourcc such as "YUYV", "MJPG"
  FrameSize size;      ///< the largest, if it takes a range
  std::vector<Duration> periods;  ///< shortest first; empty if unknown
  bool isSupported = true;        ///< whether pleinair reads this layout
};

/// The mode that a camera would be asked for.
struct ChosenMode {
  CameraMode mode;     ///< `periods`: one, or none where the camera does not say
  std::string reason;  ///< why it and no other, a line without a full stop
};

/// What a camera offers, and which of it start() would take.
struct OfferedModes {
  std::vector<CameraMode> modes;
  ChosenMode chosen;
};

/// A device as its back end describes it without streaming from it.
struct CameraDescription {
  CameraIdentity identity;
  std::string serial;  ///< empty if it has none
  /// where it is plugged in: the same for a device that comes back there; empty if unknown
  std::string path;
  std::string node;  ///< "/dev/video0"; empty if it has none
  std::vector<CameraMode> modes;
  bool areModesKnown = true;  ///< false: the camera tells them only once it is opened
  std::optional<ChosenMode>
      chosen;                    ///< for a request, where CameraBackend::offeredModes() was asked
  std::optional<Error> problem;  ///< why it could not be inspected (permissions, busy)
  /// What the back end keeps of the listing while this is held, so that opening is quick; may be
  /// null.
  std::shared_ptr<const void> kept = nullptr;
};

/// A family of cameras: lists those that are present, and makes them. One thread at a time.
class CameraBackend {
 public:
  virtual ~CameraBackend() = default;
  CameraBackend() = default;
  CameraBackend(const CameraBackend&) = delete;
  CameraBackend& operator=(const CameraBackend&) = delete;

  virtual std::string_view name() const = 0;  ///< "v4l2"

  /// The devices that are present, in an order that only plugging changes. Errors: kIo.
  virtual Result<std::vector<CameraDescription>> list() = 0;

  /// Makes the camera with that identity().id, stopped. It need not be present; start() reports
  /// that. The clock outlives the camera.
  virtual std::unique_ptr<Camera> make(const std::string& id, Clock& clock) = 0;

  /// The modes of the camera with that identity().id, and the one that start() would take for the
  /// request. Opens it without streaming, and sets nothing that lasts. Errors: those of start().
  virtual Result<OfferedModes> offeredModes(const std::string& id, const StreamRequest&) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = id,
                                .problem = "does not tell its modes before it streams"});
  }
};

}  // namespace pleinair::hal
