#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "hal/captured_frame.h"
#include "hal/clock.h"
#include "hal/error.h"
#include "hal/pixel_format.h"

namespace pleinair::hal {

/// The device's own control loop decides.
struct Automatic {
  friend bool operator==(const Automatic&, const Automatic&) = default;
};
template <class T>
using AutomaticOr = std::variant<Automatic, T>;

/// What can be set of a camera, by neutral names; unset: left as the device has it. A back end
/// converts to the device's units and clamps to its range; what the device does not have is an
/// error of start() (kUnsupported) that names the control.
struct CameraControls {
  std::optional<AutomaticOr<Duration>> exposure;
  std::optional<AutomaticOr<double>> gain;   ///< share of the device's range, 0 … 1
  std::optional<AutomaticOr<double>> focus;  ///< likewise, 0 … 1, in the device's direction
  std::optional<AutomaticOr<double>> whiteBalance;  ///< colour temperature, K
  friend bool operator==(const CameraControls&, const CameraControls&) = default;
};

/// What a consumer would like; a camera answers with what it does. Unset: the camera's choice.
struct StreamRequest {
  std::optional<FrameSize> size;
  std::optional<PixelFormat> pixelFormat;
  std::optional<Duration> framePeriod;
  CameraControls controls;
};

/// What a camera does deliver, read back after negotiation.
struct StreamFormat {
  FrameFormat frame;
  std::optional<Duration> framePeriod;      ///< nominal; unset where it has none (single pictures)
  std::optional<std::uint64_t> frameCount;  ///< of recordings, where the file says
};

struct CameraIdentity {
  std::string backend;  ///< "recording", "synthetic", "v4l2" …
  std::string id;       ///< stable across restarts and ports where the device allows
  std::string description;
};

/// No frame came before the deadline; the stream may well go on.
struct CameraTimeout {};
/// Frames from now on have this format.
struct FormatChanged {
  StreamFormat format;
};
/// A recording has ended. `truncated` says why where it broke off before its proper end.
struct EndOfStream {
  std::optional<Error> truncated;
};
/// The device is gone; stop(), and start() again once it is back.
struct CameraLost {
  Error cause;
};
using NextFrame =
    std::variant<CapturedFrame, CameraTimeout, FormatChanged, EndOfStream, CameraLost, Error>;

/// A source of frames: a device, a recording, or a simulation. The same contract for all of them,
/// held by one conformance suite (tests/conformance/camera_conformance.h).
///
/// States: stopped → start() → streaming → stop() → stopped, as often as wanted. After EndOfStream,
/// CameraLost or Error, next() keeps answering the same until stop(). All calls come from one
/// thread, except that frames may outlive the camera and be dropped anywhere.
class Camera {
 public:
  virtual ~Camera() = default;
  Camera() = default;
  Camera(const Camera&) = delete;
  Camera& operator=(const Camera&) = delete;

  virtual CameraIdentity identity() const = 0;

  /// Negotiates and starts. Precondition: stopped. A recording starts at its first frame each time.
  /// Errors: kNotFound, kPermissionDenied, kBusy, kInvalidInput (broken file), kUnsupported
  /// (size beyond the limits, no usable format), kIo.
  virtual Result<StreamFormat> start(const StreamRequest& request) = 0;

  /// The next frame, or why there is none. Waits until `deadline` on the camera's clock at the
  /// latest; kNoDeadline waits for ever. Precondition: streaming. Sequence numbers and capture
  /// times rise strictly.
  virtual NextFrame next(TimePoint deadline) = 0;

  /// Stops; idempotent; returns within a bounded time whatever the device does. Frames still leased
  /// stay valid.
  virtual void stop() = 0;
};

}  // namespace pleinair::hal
