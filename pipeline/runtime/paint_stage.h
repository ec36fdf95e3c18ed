#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "hal/image.h"
#include "pipeline/runtime/capture_stage.h"
#include "pipeline/runtime/duration_histogram.h"
#include "pipeline/runtime/frame_ledger.h"
#include "pipeline/runtime/frame_painter.h"
#include "pipeline/runtime/frame_rate.h"
#include "pipeline/runtime/latency_control.h"
#include "pipeline/runtime/mailbox.h"
#include "pipeline/runtime/output_stage.h"
#include "pipeline/runtime/quality_governor.h"

namespace pleinair::runtime {

struct PaintStageOptions {
  GovernorRules governor;
  LatencyRules latency;
  /// What a frame may take at the most, whatever the latency: the camera's period, or a longer one
  /// where fewer frames are wanted; unset: only the latency counts.
  std::optional<hal::Duration> framePeriod;
};

/// Paints the newest frame, watches what that costs, and gives the pictures to the outputs.
/// start(), step(), wait() and stop() are the paint thread's, on which the painter and its GL
/// context live and die; the rest is any thread's.
class PaintStage {
 public:
  /// The outputs outlive this, or are released first (remove(), hasLetGoOf()).
  PaintStage(PainterFactory factory, std::vector<OutputStage*> outputs, PaintStageOptions options,
             hal::Clock& clock, FrameLedger& ledger, Mailbox<ArrivedFrame>& frames);
  ~PaintStage();

  /// Makes the painter. Throws hal::Failure.
  void start();
  /// Collects what is finished and begins to paint what has come. Whether it did anything.
  bool step();
  /// Until there may be something for step() to do; by real time. It sleeps on the mailbox and,
  /// while pictures are in flight, on the GPU's fence of the oldest, 1 ms at a time where another
  /// frame could be begun and 2 ms where not: a frame that comes or a stop() waits that long at the
  /// most.
  void wait();
  /// Lets wait() return where it sleeps on the mailbox. Any thread.
  void wake() { frames_.wake(); }
  /// Ends what is in flight as kStopped; frees the painter.
  void stop();

  /// From the next step() on, frames are painted for this output too. Any thread.
  void add(OutputStage& output);
  /// From the next step() on, no more frames are painted for this output; its frames in flight end
  /// as kStopped, and its wait() is woken. Once for each output. Any thread.
  void remove(OutputStage& output);
  /// Whether neither add() nor remove() of the output is pending: once removed, it is not used any
  /// more and may be destroyed. Any thread.
  bool hasLetGoOf(const OutputStage& output) const;

  /// During a pause the frame that came last is painted again and again, so that tuning shows.
  void setPaused(bool on) { isPaused_ = on; }
  /// Whether something is being painted.
  bool isBusy() const { return busy_.load() > 0; }

  struct Stage {
    std::string_view name;
    DurationHistogram recent;
    std::uint64_t count = 0;  ///< of all
    hal::Duration sum{0};     ///< of all
  };
  struct Status {
    std::size_t quality = 0;
    std::uint64_t qualityLowered = 0, qualityRaised = 0;
    hal::Duration latency{0}, configuredLatency{0};
    std::uint64_t latencyRaised = 0, latencyLowered = 0;
    std::uint64_t painted = 0, failures = 0, contextLosses = 0;
    bool hasPainter = false;
    std::optional<hal::Error> failure;  ///< the last
    double perSecond = 0.0;
    double load = 0.0;  ///< of the budget, the last frame's
    std::vector<Stage> stages;
    std::vector<gpu::PassTime> passes;  ///< of the frames that were timed
  };
  Status status() const;

 private:
  /// A frame that is being painted.
  struct InFlight {
    std::optional<FrameLedger::Ticket> ticket;  ///< none for repeats
    hal::TimePoint captured;
    hal::TimePoint arrived;
    hal::TimePoint began;
    hal::TimePoint issued;
    std::size_t quality = 0;
    std::size_t waitedForBy = 0;  ///< how many outputs have not got it
  };
  struct Output {
    OutputStage* stage = nullptr;
    std::size_t id = 0;     ///< the painter's
    std::size_t taken = 0;  ///< how many of inFlight_ it has got, or was not there for
  };
  /// One on the GPU while the next is tracked; more would only wait there and grow old.
  static constexpr std::size_t kMaxInFlight = 2;

  void noteSuspension();
  void handleRequests();
  void open(OutputStage& output);
  void close(OutputStage& output);
  bool collect();
  bool collectFor(Output& output);
  void removeFinished();
  void finished(const InFlight& frame, hal::TimePoint now);
  double loadOf(const InFlight& frame, hal::TimePoint now) const;
  bool paintNewest();
  hal::Result<void> paint(const ArrivedFrame& arrived);
  void hold(const hal::CapturedFrame& frame);
  void refuse(const ArrivedFrame& arrived, const hal::Error& error);
  void endInFlight(Outcome outcome);
  void lose(const hal::Error& error);
  bool revive();

  PainterFactory factory_;
  std::vector<Output> outputs_;
  std::size_t nextId_ = 0;
  PaintStageOptions options_;
  hal::Clock& clock_;
  FrameLedger& ledger_;
  Mailbox<ArrivedFrame>& frames_;

  std::unique_ptr<FramePainter> painter_;
  hal::TimePoint reviveAt_;
  hal::Duration reviveAfter_;
  std::vector<InFlight> inFlight_;  ///< oldest first, kMaxInFlight at the most
  std::optional<hal::Image> held_;  ///< of a pause
  hal::TimePoint lastFinished_;
  hal::TimePoint lastStep_;
  hal::TimePoint resumedAt_;
  std::atomic<bool> isPaused_ = false;
  std::atomic<std::size_t> busy_ = 0;

  enum StageIndex : std::size_t { kDelay, kWaiting, kIssuing, kFinishing, kReady };
  mutable std::mutex mutex_;  // of what follows
  QualityGovernor governor_;
  LatencyControl latency_;
  std::array<RecentDurations, 5> stages_;
  FrameRate rate_;
  std::uint64_t painted_ = 0, failures_ = 0, contextLosses_ = 0;
  std::optional<hal::Error> failure_;
  bool hasPainter_ = false;
  double load_ = 0.0;
  std::vector<gpu::PassTime> passes_;
  std::vector<OutputStage*> toOpen_;   ///< asked for with add()
  std::vector<OutputStage*> toClose_;  ///< with remove(); until they are let go of
};

}  // namespace pleinair::runtime
