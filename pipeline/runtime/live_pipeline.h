#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "hal/clock.h"
#include "hal/output.h"
#include "hal/supervisor/camera_supervisor.h"
#include "pipeline/runtime/capture/capture_stage.h"
#include "pipeline/runtime/frame_ledger.h"
#include "pipeline/runtime/mailbox.h"
#include "pipeline/runtime/output/output_stage.h"
#include "pipeline/runtime/paint/paint_stage.h"
#include "pipeline/runtime/status/runtime_status.h"

namespace pleinair::runtime {

/// The stages from a camera to the outputs, the mailbox between camera and painter, and the ledger
/// that every frame is entered into. It has no threads: LiveThreads runs each stage on one, and a
/// test under a SteppedClock steps them in turn, with the same result on every run.
///
/// Order of calls: step capture() until its status has a format; addOutput(), at least once;
/// makePaintStage(); paint().start(); capture().open(); then the stages in any order. Outputs may
/// be added and removed after that too. Main thread, unless a call says otherwise.
class LivePipeline {
 public:
  /// The camera and the clock outlive this.
  LivePipeline(hal::CameraSupervisor& camera, hal::Clock& clock);

  /// Adds an output that was started and answered `format`, or null for one that is waited for
  /// (OutputStageOptions::absence). Once there is a paint stage, frames are
  /// painted for it from that stage's next step on.
  OutputStage& addOutput(std::unique_ptr<hal::Output> output, hal::OutputFormat format,
                         OutputStageOptions options);
  /// The latency changes in steps of the longest refresh period of the outputs present now.
  /// Precondition: there is an output.
  void makePaintStage(PainterFactory factory, PaintStageOptions options);

  /// Stops painting for an output, from the paint stage's next step on. The output stays among the
  /// others until takeRemoved() gives it. Precondition: there is a paint stage.
  void removeOutput(OutputStage& output);
  /// Whether the paint stage has stopped using a removed output. Any thread.
  bool hasReleased(const OutputStage& output) const { return paint_->hasReleased(output); }
  /// Hands over a removed output; null until hasReleased() is true. The caller no longer steps it,
  /// calls finish(), unless that was done, and destroys it. Status and outputCount() leave it out;
  /// its frames stay in the ledger.
  std::unique_ptr<OutputStage> takeRemoved(OutputStage& output);

  hal::CameraSupervisor& camera() { return camera_; }
  hal::Clock& clock() { return clock_; }
  CaptureStage& capture() { return capture_; }
  PaintStage& paint() { return *paint_; }
  std::size_t outputCount() const { return outputs_.size(); }
  OutputStage& output(std::size_t index) { return *outputs_.at(index); }
  const OutputStage& output(std::size_t index) const { return *outputs_.at(index); }
  const FrameLedger& ledger() const { return ledger_; }

  /// Whether the camera has ended and all of its frames have an outcome. Any thread.
  bool isDrained() const;
  /// A copy of the state of all stages. Any thread, once there is a paint stage.
  RuntimeStatus status() const;

 private:
  hal::CameraSupervisor& camera_;
  hal::Clock& clock_;
  hal::TimePoint began_;
  FrameLedger ledger_;
  Mailbox<ArrivedFrame> frames_;
  CaptureStage capture_;
  mutable std::mutex outputsMutex_;  ///< guards outputs_ against status()
  std::vector<std::unique_ptr<OutputStage>> outputs_;
  std::optional<PaintStage> paint_;
};

}  // namespace pleinair::runtime
