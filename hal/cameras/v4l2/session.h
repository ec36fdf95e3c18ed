#pragma once

#include <memory>
#include <optional>

#include "hal/camera.h"
#include "hal/cameras/v4l2/chronology.h"
#include "hal/cameras/v4l2/device.h"
#include "hal/cameras/v4l2/format.h"
#include "hal/cameras/v4l2/stream.h"

namespace pleinair::hal::v4l2 {

/// A camera from start() to stop(). One thread; frames may be dropped on any.
class Session {
 public:
  Session(Device device, const StreamRequest& request, Clock& clock);

  /// Sets the controls, negotiates and starts. Errors: as Camera::start().
  Result<StreamFormat> begin();
  /// As Camera::next().
  NextFrame next(TimePoint deadline);

 private:
  /// Processes one event. Gives next()'s answer, or nothing after a spurious wake-up.
  std::optional<NextFrame> step(TimePoint deadline);
  std::optional<NextFrame> readFrame(TimePoint deadline);
  CapturedFrame frameOf(Filled filled);
  /// Resets each pixel offset behind which a whole image has no room to 0. False if there was one.
  bool fitIntoBuffer(Filled& filled) const;
  void lendPixels(const Filled& filled, CapturedFrame& frame);
  void decodePixels(const Filled& filled, CapturedFrame& frame);
  ImageView viewOf(const Filled& filled) const;
  bool isSourceChanged() const;
  Result<void> restart();
  std::optional<NextFrame> followSource();
  /// Stores the answer, which every later call repeats.
  NextFrame end(NextFrame answer);
  NextFrame fail(std::string problem, int answer);

  Device device_;
  StreamRequest request_;
  Clock& clock_;
  Negotiated negotiated_;
  Chronology chronology_;
  std::unique_ptr<Stream> stream_;  ///< destroyed before device_
  bool wasStarving_ = false;
  int requeueFailure_ = 0;                 ///< −errno, reported by the next call
  bool hasFrames_ = false;                 ///< since the device was last started
  std::shared_ptr<const void> lastLease_;  ///< of the last valid JPEG
  ImageView lastPicture_;
  std::optional<NextFrame> ended_;
};

}  // namespace pleinair::hal::v4l2
