#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "hal/clock.h"
#include "hal/output.h"
#include "hal/supervisor/camera_supervisor.h"
#include "pipeline/runtime/capture_stage.h"
#include "pipeline/runtime/frame_ledger.h"
#include "pipeline/runtime/mailbox.h"
#include "pipeline/runtime/output_stage.h"
#include "pipeline/runtime/paint_stage.h"
#include "pipeline/runtime/runtime_status.h"

namespace pleinair::runtime {

/// From a camera to the outputs, live: stages with one-frame mailboxes between them, and the ledger
/// that every frame is entered into. Runs nothing by itself: LiveThreads gives each stage a thread;
/// under a SteppedClock whoever steps the stages in turn has the same pipeline, repeatable.
///
/// Order: step capture() until its status has a format; addOutput(), at least one;
/// makePaintStage(); paint().start(); then capture().open() and all stages at will. Outputs may
/// come and go after that too. Main thread, where a call says no other.
class LivePipeline {
 public:
  /// Both outlive this.
  LivePipeline(hal::CameraSupervisor& camera, hal::Clock& clock);

  OutputStage& addOutput(std::unique_ptr<hal::Output> output, hal::OutputFormat format,
                         OutputStageOptions options);
  /// The step by which the latency changes is the longest refresh of the outputs that have one.
  void makePaintStage(PainterFactory factory, PaintStageOptions options);

  /// Stops painting for an output, from the paint stage's next step on. The output stays among the
  /// others until takeRemoved() gives it. Precondition: there is a paint stage.
  void removeOutput(OutputStage& output);
  /// Whether the paint stage has stopped using a removed output. Any thread.
  bool hasLetGoOf(const OutputStage& output) const { return paint_->hasLetGoOf(output); }
  /// Hands over a removed output; null until hasLetGoOf() is true. The caller no longer steps it,
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

  /// Whether the camera has ended and every frame of it too. Any thread.
  bool isDrained() const;
  /// All that is known at this moment. Any thread, once there is a paint stage.
  RuntimeStatus status() const;

 private:
  hal::CameraSupervisor& camera_;
  hal::Clock& clock_;
  hal::TimePoint began_;
  FrameLedger ledger_;
  Mailbox<ArrivedFrame> frames_;
  CaptureStage capture_;
  mutable std::mutex outputsMutex_;  ///< of outputs_, for threads that ask for the status
  std::vector<std::unique_ptr<OutputStage>> outputs_;
  std::optional<PaintStage> paint_;
};

}  // namespace pleinair::runtime
