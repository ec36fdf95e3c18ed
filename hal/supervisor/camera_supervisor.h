#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/error.h"
#include "hal/supervisor/back_off.h"
#include "hal/supervisor/camera_selector.h"
#include "hal/supervisor/frame_watchdog.h"
#include "hal/supervisor/session_frames.h"

namespace pleinair::hal {

/// opening → streaming → stalled → lost → backing off → opening …; a stalled camera may stream
/// again by itself. Ended: a recording's end, or stop().
enum class CameraState {
  kOpening,    ///< until the first frame came
  kStreaming,  ///< frames come
  kStalled,    ///< open, but no usable frame has come for longer than the watchdog's limit
  kLost,       ///< given up: an error, unplugged, could not be opened, or stalled for too long
  kBackingOff,
  kEnded,
};
std::string_view toString(CameraState state);  ///< "opening", "backing off" …

struct CameraStateChanged {
  CameraState state = CameraState::kOpening;
  std::string reason;  ///< one line: what the device did, or what opening it failed with
  /// The camera that it is about; none while one is looked for.
  std::optional<CameraIdentity> camera;
  /// With kLost, what the back end or the selection said; none where the watchdog gave it up.
  std::optional<Error> cause;
};

using SupervisedNext =
    std::variant<SupervisedFrame, CameraTimeout, FormatChanged, CameraStateChanged, EndOfStream>;

struct SupervisorOptions {
  WatchdogRule watchdog;
  BackOffRule backOff;
  /// A stalled camera is torn down and opened anew after being silent for this long beyond the
  /// watchdog's limit.
  Duration stallPatience = std::chrono::seconds(3);
  /// The longest that a device may take from its start to its first usable frame.
  Duration firstFrameLimit = std::chrono::seconds(5);
  /// A device change (hot-plug) is followed by an opening this much later: udev tells of a camera's
  /// several nodes one after another.
  Duration settleTime = std::chrono::milliseconds(100);
  /// The longest single wait in the camera: how late wake() and stop() may be noticed.
  Duration longestLook = std::chrono::milliseconds(50);
};

/// Since the supervisor was made.
struct SupervisorCounts {
  std::uint64_t opens = 0;         ///< that worked
  std::uint64_t openFailures = 0;  ///< of the whole selection
  std::uint64_t losses = 0;        ///< of an open camera
  std::uint64_t errors = 0;        ///< of those, by an Error of the back end
  std::uint64_t stalls = 0;
  std::uint64_t resumptions = 0;  ///< stalls that ended by themselves
  FrameCounts frames;
};

struct SupervisorStatus {
  CameraState state = CameraState::kOpening;
  std::string reason;
  std::optional<CameraIdentity> camera;
  SupervisorCounts counts;
};

/// Keeps a camera streaming, whatever happens to it: opens what the selector chooses, watches that
/// frames come, and opens anew what was lost, after a pause that grows. Pull-based as Camera, so
/// that all is deterministic under a SteppedClock: there is no thread in here; whoever calls next()
/// owns the device, and the destructor belongs to the same thread.
///
/// What comes out, for each opening: CameraStateChanged (kOpening), FormatChanged, whenever the
/// format is not the last one told, CameraStateChanged (kStreaming), and frames. Between kLost and
/// the next kOpening comes kBackingOff. Sequence numbers and capture times of the frames rise
/// strictly across all openings (SupervisedFrame says what the gaps were).
///
/// Recordings and simulations (OpenedCamera::isDevice false) are not watched for silence: their
/// pauses are what was recorded. Their end is kEnded; where they fail, they are lost as devices
/// are. To fail at start-up rather than wait for a camera, see that no kLost comes before the first
/// FormatChanged, and throw its cause.
class CameraSupervisor {
 public:
  /// The selector and the clock outlive this. Nothing is opened before next().
  CameraSupervisor(CameraSelector& selector, Clock& clock, SupervisorOptions options = {},
                   StreamRequest request = {});
  ~CameraSupervisor();
  CameraSupervisor(const CameraSupervisor&) = delete;
  CameraSupervisor& operator=(const CameraSupervisor&) = delete;

  /// What happened next, or CameraTimeout at `deadline`. Never fails. Overruns the deadline by no
  /// more than one opening or closing takes. After kEnded it keeps answering EndOfStream.
  SupervisedNext next(TimePoint deadline);

  /// next() returns soon, if only with CameraTimeout. Any thread.
  void wake();
  /// Something was plugged or unplugged: a back-off is cut short, and starts small again. Any
  /// thread.
  void devicesChanged();
  /// The next next() closes the camera and ends; one that waits is woken, in an opening too. The
  /// selector opens nothing more. Returns at once. Any thread.
  void stop();

  /// All frames so far, with those that came after the last one that was let out. The thread of
  /// next(); status() has them for the others.
  FrameCounts frameCounts() const { return frames_.counts(); }
  CameraState state() const { return state_.load(); }  ///< any thread
  SupervisorStatus status() const;                     ///< any thread

 private:
  SupervisedNext advance(TimePoint deadline);
  std::optional<SupervisedNext> takePending();
  void enter(CameraState state, std::string reason, std::optional<Error> cause = std::nullopt);
  void tell(const StreamFormat& format);

  void step(TimePoint deadline);
  void open();
  void close();
  /// Takes one look at the open camera, until `deadline` at the latest.
  void look(TimePoint deadline);
  void receive(CapturedFrame frame);
  void receiveEnd(EndOfStream end);
  void hand(SupervisedFrame frame);
  void noteSilence();
  std::string silenceText() const;
  void lose(std::string reason, std::optional<Error> cause = std::nullopt);
  void end(std::string reason, std::optional<Error> truncated = std::nullopt);
  void closeAndBackOff();
  /// Waits for the time to open again, or `deadline`.
  void backOff(TimePoint deadline);

  void noteDeviceChange();
  bool takeWake();
  std::stop_token wakeToken() const;
  void publishCounts();

  CameraSelector& selector_;
  Clock& clock_;
  SupervisorOptions options_;
  StreamRequest request_;

  std::optional<OpenedCamera> opened_;
  std::optional<CameraIdentity> camera_;
  std::optional<StreamFormat> told_;
  std::optional<Error> truncated_;
  TimePoint startedAt_;
  TimePoint streamingSince_;
  TimePoint openAgainAt_;
  BackOff backOff_;
  FrameWatchdog watchdog_;
  SessionFrames frames_;
  FrameCounts framesBeforeSilence_;
  SupervisorCounts counts_;
  // Handed out one by one; its memory is kept, for there is one for each frame.
  std::vector<SupervisedNext> pending_;
  std::size_t handedOut_ = 0;

  std::atomic<CameraState> state_ = CameraState::kOpening;
  std::atomic<bool> isStopped_ = false;
  std::atomic<bool> haveDevicesChanged_ = false;
  mutable std::mutex mutex_;  // of what follows
  SupervisorStatus status_;
  std::stop_source woken_;
};

}  // namespace pleinair::hal
