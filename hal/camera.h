#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "hal/captured_frame.h"
#include "hal/clock.h"
#include "hal/error.h"
#include "hal/frame_allocator.h"
#include "hal/pixel_format.h"

namespace pleinair::hal {

/// The device's own control loop sets the value.
struct Automatic {
  friend bool operator==(const Automatic&, const Automatic&) = default;
};
template <class T>
using AutomaticOr = std::variant<Automatic, T>;

/// Camera controls by neutral names. An unset control keeps the device's value. A back end converts
/// to the device's units and clamps to its range. start() answers kUnsupported and names the
/// control if the device lacks it.
struct CameraControls {
  std::optional<AutomaticOr<Duration>> exposure;
  std::optional<AutomaticOr<double>> gain;   ///< share of the device's range, 0 … 1
  std::optional<AutomaticOr<double>> focus;  ///< focus position in the device's direction, 0 … 1
  std::optional<AutomaticOr<double>> whiteBalance;  ///< colour temperature, K
  friend bool operator==(const CameraControls&, const CameraControls&) = default;
};

/// The stream that a consumer asks for. The camera picks each unset value, and answers with the
/// StreamFormat that it delivers.
struct StreamRequest {
  std::optional<FrameSize> size;
  std::optional<PixelFormat> pixelFormat;
  std::optional<Duration> framePeriod;
  CameraControls controls;
  /// Memory for its frames; null: the device's own. A camera that cannot use it takes its own.
  std::shared_ptr<FrameAllocator> allocator = nullptr;
  /// Asks for a second, small image of each frame, for trackers (CapturedFrame::luma): the longer
  /// side, in px. A camera that makes none, or whose frames are no larger, delivers none.
  std::optional<int> lumaSidePx = std::nullopt;
};

/// Who has allocated the memory of frames.
enum class FrameMemory {
  kProcessor,  ///< ordinary memory of the program
  kExported,   ///< the device's, with dma-bufs
  kLent,       ///< StreamRequest::allocator
};
std::string_view toString(FrameMemory memory);

/// The format that a camera delivers, read back after negotiation.
struct StreamFormat {
  FrameFormat frame;
  std::optional<Duration> framePeriod;      ///< nominal; unset for a single picture, which has none
  std::optional<std::uint64_t> frameCount;  ///< recordings only, if the file states it
  /// Frames come when a signal from outside asks for them: silence is no fault of the camera.
  bool isTriggered = false;
  /// What is likely to spoil the stream and how to fix it, a line for the user; empty: nothing.
  std::string warning;
  /// Where its frames lie, but for copies that are made while all buffers are leased.
  FrameMemory memory = FrameMemory::kProcessor;
  std::string memoryNote;  ///< the allocator's name, or why it was not used; may be empty
  /// The format of CapturedFrame::luma: kGrey8; unset: frames have none.
  std::optional<FrameFormat> luma = std::nullopt;
  std::string lumaNote;  ///< why they have none although it was asked for; may be empty
};

struct CameraIdentity {
  std::string backend;  ///< "recording", "synthetic", "v4l2" …
  std::string id;       ///< stable across restarts and ports where the device allows
  std::string description;
};

/// No frame came before the deadline; the stream may still go on.
struct CameraTimeout {};
/// The frames that follow have this format.
struct FormatChanged {
  StreamFormat format;
};
/// A recording has ended. `truncated` gives the reason if it ended early.
struct EndOfStream {
  std::optional<Error> truncated;
};
/// The device is gone. Call stop(), and start() again once it is back.
struct CameraLost {
  Error cause;
};
using NextFrame =
    std::variant<CapturedFrame, CameraTimeout, FormatChanged, EndOfStream, CameraLost, Error>;

/// A source of frames: a device, a recording or a simulation. One contract for all of them, tested
/// by one conformance suite (tests/conformance/camera_conformance.h).
///
/// States: stopped → start() → streaming → stop() → stopped, any number of times. After
/// EndOfStream, CameraLost or Error, next() repeats that answer until stop(). All calls come from
/// one thread. Frames may outlive the camera and may be dropped on any thread.
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

  /// Gives the next frame, or the reason why there is none. Waits at most until `deadline` on the
  /// camera's clock; kNoDeadline waits for ever. Precondition: streaming. Sequence numbers and
  /// capture times rise strictly.
  virtual NextFrame next(TimePoint deadline) = 0;

  /// Stops streaming within a bounded time, in any state of the device; idempotent. Leased frames
  /// stay valid.
  virtual void stop() = 0;
};

}  // namespace pleinair::hal
