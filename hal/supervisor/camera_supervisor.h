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

/// The states of a supervised camera: opening → streaming → stalled → lost → backing off → opening
/// … A stalled camera may go back to streaming by itself.
enum class CameraState {
  kOpening,     ///< until the first frame
  kStreaming,   ///< frames arrive
  kStalled,     ///< open, but no usable frame has come for longer than the watchdog's limit
  kLost,        ///< an error, unplugged, could not be opened, or stalled for too long
  kBackingOff,  ///< waits before the next opening
  kEnded,       ///< after the end of a recording, or stop()
};
std::string_view toString(CameraState state);  ///< "opening", "backing off" …

struct CameraStateChanged {
  CameraState state = CameraState::kOpening;
  std::string reason;  ///< one line: the device's behaviour, or the error of opening it
  /// Unset until a camera is open.
  std::optional<CameraIdentity> camera;
  /// With kLost: the error of the back end or the selector; unset if the watchdog gave up.
  std::optional<Error> cause;
};

using SupervisedNext =
    std::variant<SupervisedFrame, CameraTimeout, FormatChanged, CameraStateChanged, EndOfStream>;

struct SupervisorOptions {
  WatchdogRule watchdog;
  BackOffRule backOff;
  /// A stalled camera is closed and opened again once it has been silent for so much longer than
  /// the watchdog's limit.
  Duration stallPatience = std::chrono::seconds(3);
  /// Longest time that a device may take from its start to its first usable frame.
  Duration firstFrameLimit = std::chrono::seconds(5);
  /// Time from a hot-plug event to the next opening: udev reports the nodes of a camera one after
  /// another.
  Duration settleTime = std::chrono::milliseconds(100);
  /// Longest single wait for the camera: wake() and stop() may be noticed so much later.
  Duration maxPollInterval = std::chrono::milliseconds(50);
};

/// Counts since the construction of the supervisor.
struct SupervisorCounts {
  std::uint64_t opens = 0;         ///< successful openings
  std::uint64_t openFailures = 0;  ///< openings for which no camera of the selection worked
  std::uint64_t losses = 0;        ///< losses of an open camera
  std::uint64_t errors = 0;        ///< losses by an Error of the back end
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

/// Keeps a camera streaming: opens the selector's choice, watches that frames arrive, and opens a
/// lost camera again after a growing back-off. Like Camera it is pull-based and has no thread, so
/// that it is deterministic under a SteppedClock. The thread that calls next() owns the device and
/// destroys the supervisor.
///
/// next() gives for each opening CameraStateChanged (kOpening), FormatChanged if the format differs
/// from the last one announced, CameraStateChanged (kStreaming), and frames. kBackingOff comes
/// between kLost and the next kOpening. Sequence numbers and capture times of the frames rise
/// strictly across all openings; SupervisedFrame gives the reasons of gaps.
///
/// Recordings and simulations (OpenedCamera::isDevice false) are not watched for silence, because
/// pauses may be recorded. At their end the state is kEnded; after an error they are lost like
/// devices. A caller that wants to fail at start-up, instead of waiting for a camera, throws the
/// cause of a kLost that comes before the first FormatChanged.
class CameraSupervisor {
 public:
  /// The selector and the clock outlive this. Nothing is opened before next().
  CameraSupervisor(CameraSelector& selector, Clock& clock, SupervisorOptions options = {},
                   StreamRequest request = {});
  ~CameraSupervisor();
  CameraSupervisor(const CameraSupervisor&) = delete;
  CameraSupervisor& operator=(const CameraSupervisor&) = delete;

  /// Gives the next frame or change, or CameraTimeout at `deadline`. Never fails. Overruns the
  /// deadline at most by the duration of one opening or closing. Repeats EndOfStream after kEnded.
  SupervisedNext next(TimePoint deadline);

  /// Makes next() return soon, at least with CameraTimeout. Any thread.
  void wake();
  /// To be called when a device was plugged or unplugged: ends a back-off early and resets its
  /// duration. Any thread.
  void devicesChanged();
  /// Makes next() close the camera and end; wakes a waiting next(), also during an opening. The
  /// selector opens no more cameras. Returns at once. Any thread.
  void stop();

  /// Counts of all frames so far, including those dropped since the last delivered one. Only on the
  /// thread of next(); other threads use status().
  FrameCounts frameCounts() const { return frames_.counts(); }
  CameraState state() const { return state_.load(); }  ///< any thread
  SupervisorStatus status() const;                     ///< any thread

 private:
  SupervisedNext advance(TimePoint deadline);
  std::optional<SupervisedNext> takePending();
  void enter(CameraState state, std::string reason, std::optional<Error> cause = std::nullopt);
  void announce(const StreamFormat& format);

  void step(TimePoint deadline);
  void open();
  void close();
  /// Polls the open camera once, at most until `deadline`.
  void pollCamera(TimePoint deadline);
  void receive(CapturedFrame frame);
  void receiveEnd(EndOfStream end);
  void deliver(SupervisedFrame frame);
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
  std::optional<StreamFormat> announced_;
  std::optional<Error> truncated_;
  TimePoint startedAt_;
  TimePoint streamingSince_;
  TimePoint openAgainAt_;
  BackOff backOff_;
  FrameWatchdog watchdog_;
  SessionFrames frames_;
  FrameCounts framesBeforeSilence_;
  SupervisorCounts counts_;
  // Answers that next() gives one by one; a member so that its memory is reused.
  std::vector<SupervisedNext> pending_;
  std::size_t handedOut_ = 0;

  std::atomic<CameraState> state_ = CameraState::kOpening;
  std::atomic<bool> isStopped_ = false;
  std::atomic<bool> haveDevicesChanged_ = false;
  mutable std::mutex mutex_;  // guards the members below
  SupervisorStatus status_;
  std::stop_source woken_;
};

}  // namespace pleinair::hal
