#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/supervisor/camera_supervisor.h"
#include "pipeline/runtime/capture/movement_detector.h"
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
/// between camera and painter, where a frame that a newer one replaces ends as kReplaced. Frames
/// that the camera or its driver lost are entered under the reasons that those give. step() belongs
/// to the camera thread; any thread may call the rest.
class CaptureStage {
 public:
  /// All references outlive this.
  CaptureStage(hal::CameraSupervisor& camera, hal::Clock& clock, FrameLedger& ledger,
               Mailbox<ArrivedFrame>& frames);

  /// Waits for the camera's next frame or change of state, at most until `deadline`.
  void step(hal::TimePoint deadline);

  /// Lets frames through to the painter; until then they end as kStarting.
  void open();

  struct Status {
    hal::CameraState state = hal::CameraState::kOpening;
    std::string reason;
    std::string lastLoss;  ///< reason of the last loss; empty: none so far
    std::optional<hal::CameraIdentity> camera;
    std::optional<hal::StreamFormat> format;  ///< the last one announced
    std::uint64_t arrived = 0;                ///< frames that were let through to the painter
    double perSecond = 0.0;
    std::uint64_t stalls = 0, losses = 0, opens = 0;
    hal::LinkCounts link;                ///< packets of all its openings
    std::optional<hal::Duration> quiet;  ///< since movedAt()
    hal::Duration delay{0};              ///< recent median time from capture to arrival
    bool hasEnded = false;               ///< no more frames will come
    std::optional<hal::Error> cause;     ///< of the last loss, or of a truncated recording
  };
  Status status() const;

  /// When something last moved before the camera, as far as it was looked at; unset: not yet. Each
  /// time that a camera begins counts as a movement.
  std::optional<hal::TimePoint> movedAt() const;

 private:
  void countLost();
  void handOn(hal::CapturedFrame frame);

  hal::CameraSupervisor& camera_;
  hal::Clock& clock_;
  FrameLedger& ledger_;
  Mailbox<ArrivedFrame>& frames_;
  bool hasEnded_ = false;
  hal::FrameCounts counted_;  ///< the supervisor's counts that are in the ledger
  MovementDetector movement_;

  mutable std::mutex mutex_;  // guards the members below
  bool isOpen_ = false;
  Status status_;
  std::optional<hal::TimePoint> movedAt_;
  FrameRate rate_;
  RecentDurations delay_;
};

}  // namespace pleinair::runtime
