#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/supervisor/camera_supervisor.h"
#include "pipeline/runtime/duration_histogram.h"
#include "pipeline/runtime/frame_ledger.h"
#include "pipeline/runtime/frame_rate.h"
#include "pipeline/runtime/mailbox.h"

namespace pleinair::runtime {

/// A captured frame on its way to the painter.
struct ArrivedFrame {
  hal::CapturedFrame frame;
  FrameLedger::Ticket ticket;
  hal::TimePoint arrived;
};

/// Takes frames from a supervised camera, enters each into the ledger, and puts it into the mailbox
/// between camera and painter, the only one: a frame that a newer one takes the place of ends
/// there, as kReplaced. Frames lost before ended in the camera or its driver, which say why. step()
/// is the camera thread's, the rest is any thread's.
class CaptureStage {
 public:
  /// All outlive this.
  CaptureStage(hal::CameraSupervisor& camera, hal::Clock& clock, FrameLedger& ledger,
               Mailbox<ArrivedFrame>& frames);

  /// Waits for what the camera does next, until `deadline`.
  void step(hal::TimePoint deadline);

  /// From now on frames are handed on; before, they end as kStarting.
  void open();

  struct Status {
    hal::CameraState state = hal::CameraState::kOpening;
    std::string reason;
    std::string lastLoss;  ///< why the camera was lost last; empty: never
    std::optional<hal::CameraIdentity> camera;
    std::optional<hal::StreamFormat> format;  ///< the last one told
    double perSecond = 0.0;
    std::uint64_t stalls = 0, losses = 0, opens = 0;
    hal::Duration delay{0};           ///< from capture to here, the median of late
    bool hasEnded = false;            ///< no frame comes any more
    std::optional<hal::Error> cause;  ///< of the last loss, or why the recording broke off
  };
  Status status() const;

 private:
  void countLost();
  void handOn(hal::CapturedFrame frame);

  hal::CameraSupervisor& camera_;
  hal::Clock& clock_;
  FrameLedger& ledger_;
  Mailbox<ArrivedFrame>& frames_;
  bool hasEnded_ = false;
  hal::FrameCounts counted_;  ///< what the ledger has of the supervisor's

  mutable std::mutex mutex_;  // of what follows
  bool isOpen_ = false;
  Status status_;
  FrameRate rate_;
  RecentDurations delay_;
};

}  // namespace pleinair::runtime
