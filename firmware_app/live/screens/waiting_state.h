#pragma once

#include <cstdint>
#include <string>

#include "hal/clock.h"
#include "pipeline/present/waiting_picture.h"
#include "pipeline/runtime/capture/capture_stage.h"

namespace pleinair::app {

/// The thing that a screen waits for.
enum class Awaited {
  kNothing,      ///< it shows paintings
  kCamera,       ///< the first frame of one
  kPainter,      ///< that is made, for the first time or for another style
  kCameraAgain,  ///< that was lost or is silent
  kGpu,          ///< that was lost
  kPace,         ///< frames come, but nothing is painted in time
};

/// What is known of the live pipeline.
struct LiveProgress {
  const runtime::CaptureStage::Status& camera;
  bool hasBegun = false;      ///< frames may flow to the outputs
  bool hasPainter = false;    ///< it has one now
  bool isRenewing = false;    ///< another one is made for another style
  std::uint64_t painted = 0;  ///< frames so far
};

/// Decides what the screens wait for. One thread.
class WaitingState {
 public:
  /// So long nothing is painted before painting counts as too slow.
  static constexpr hal::Duration kTooSlow = std::chrono::seconds(4);

  void update(const LiveProgress& progress, hal::TimePoint now);
  Awaited awaited(hal::TimePoint now) const;

 private:
  Awaited awaited_ = Awaited::kCamera;
  bool isOver_ = false;  ///< no more frames come
  std::uint64_t painted_ = 0;
  std::uint64_t arrived_ = 0;  ///< frames, when these changed
  hal::TimePoint since_;       ///< when these changed, or a camera still waited for its trigger
};

/// What a picture says meanwhile. `choice`: the camera that was asked for.
present::WaitingText waitingText(Awaited awaited, const runtime::CaptureStage::Status& camera,
                                 const std::string& choice);

}  // namespace pleinair::app
