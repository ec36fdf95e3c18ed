#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hal/clock.h"
#include "hal/image.h"
#include "pipeline/runtime/capture/capture_stage.h"
#include "pipeline/runtime/control/latency_control.h"
#include "pipeline/runtime/control/quality_governor.h"
#include "pipeline/runtime/duration_histogram.h"
#include "pipeline/runtime/frame_ledger.h"
#include "pipeline/runtime/frame_rate.h"
#include "pipeline/runtime/mailbox.h"
#include "pipeline/runtime/output/output_stage.h"
#include "pipeline/runtime/paint/frame_painter.h"

namespace pleinair::runtime {

struct PaintStageOptions {
  GovernorRules governor;
  LatencyRules latency;
  /// Time budget of a frame, whatever the latency: the camera's period, or a longer one if
  /// [runtime] rate is lower; unset: only the latency limits it.
  std::optional<hal::Duration> framePeriod;
};

/// Paints the newest frame, controls quality and latency by its cost, and passes output frames to
/// the output stages. start(), step(), wait() and stop() belong to the paint thread, where the
/// painter and its GL context are created, used and destroyed; any thread may call the rest.
class PaintStage {
 public:
  /// All references, and the outputs until they are released (remove(), hasReleased()), outlive
  /// this. Precondition: there is an output.
  PaintStage(PainterFactory factory, const std::vector<OutputStage*>& outputs,
             PaintStageOptions options, hal::Clock& clock, FrameLedger& ledger,
             Mailbox<ArrivedFrame>& frames);
  ~PaintStage();
  PaintStage(const PaintStage&) = delete;
  PaintStage& operator=(const PaintStage&) = delete;

  /// Makes the painter. Throws hal::Failure; also where it can be opened for none of the outputs.
  void start();
  /// Collects finished frames and begins to paint the newest one. Returns whether it did either.
  bool step();
  /// Waits, in real time, until there may be something for step() to do: on the mailbox or, while
  /// frames are in flight, on the GPU's fence of the oldest. It waits on a fence for 1 ms at a time
  /// if another frame could be begun and 2 ms otherwise, which is how long a new frame or a stop()
  /// may be delayed.
  void wait();
  /// Ends a wait() on the mailbox. Any thread.
  void wake() { frames_.wake(); }
  /// Ends frames in flight as kStopped and destroys the painter.
  void stop();

  /// Frames are painted for this output too, from the next step() on. Any thread.
  void add(OutputStage& output);
  /// No more frames are painted for this output from the next step() on, which ends its frames in
  /// flight as kStopped and wakes its wait(). Precondition: it was not removed before. Any thread.
  void remove(OutputStage& output);
  /// Whether a removed output is no longer used and may be destroyed: neither its add() nor its
  /// remove() is pending. Any thread.
  bool hasReleased(const OutputStage& output) const;

  /// Makes another painter in place of this one, which paints in another way. No frame is begun
  /// until it is there; those in flight are finished by the old one. Any thread.
  void renew();

  /// Another time budget of a frame (PaintStageOptions), from the next frame on. Any thread.
  void setFramePeriod(std::optional<hal::Duration> period);

  /// Permits this quality level and lower ones only, from the next frame on; 0: all. A level that
  /// is kept stays. Any thread.
  void limitQuality(std::size_t best);

  /// During a pause the last frame is painted repeatedly, so that changed parameters show.
  void setPaused(bool on) { isPaused_ = on; }
  /// Whether a frame is in flight.
  bool isBusy() const { return busy_.load() > 0; }

  struct Stage {
    std::string_view name;
    DurationHistogram recent;
    std::uint64_t count = 0;  ///< since the start
    hal::Duration sum{0};     ///< since the start
  };
  struct Status {
    std::size_t quality = 0;
    std::size_t bestQuality = 0;  ///< that limitQuality() permits
    std::uint64_t qualityLowered = 0, qualityRaised = 0;
    hal::Duration latency{0}, configuredLatency{0};
    std::uint64_t latencyRaised = 0, latencyLowered = 0;
    std::uint64_t painted = 0, failures = 0, contextLosses = 0;
    bool hasPainter = false;
    bool isRenewing = false;            ///< after renew(), until there is a new painter
    std::optional<hal::Error> failure;  ///< the last one
    double perSecond = 0.0;
    double load = 0.0;  ///< share of its budget that the last frame took
    std::vector<Stage> stages;
    std::vector<gpu::PassTime> passes;     ///< in the timed frames
    std::optional<CameraPath> cameraPath;  ///< of frames to the GPU, once one was painted
  };
  Status status() const;
  /// The part of Status that the main thread reads many times a second; its copy has no histograms.
  struct Progress {
    std::size_t quality = 0;
    std::uint64_t painted = 0;
    bool hasPainter = false;
    bool isRenewing = false;
  };
  Progress progress() const;

 private:
  /// A frame that is being painted.
  struct InFlight {
    std::optional<FrameLedger::Ticket> ticket;  ///< unset for repeats
    hal::TimePoint captured;
    hal::TimePoint arrived;
    hal::TimePoint began;
    hal::TimePoint issued;
    std::size_t quality = 0;
    std::size_t pendingOutputs = 0;  ///< number of outputs that have not got it
  };
  struct Output {
    OutputStage* stage = nullptr;
    bool isOpen = false;       ///< in the painter
    std::size_t id = 0;        ///< its number there
    hal::OutputFormat format;  ///< that the painter brings its frames to
    std::size_t taken = 0;  ///< number of the first frames of inFlight_ that it has got or missed
  };
  /// One on the GPU while the next is tracked. More would only wait there and add latency.
  static constexpr std::size_t kMaxInFlight = 2;

  void noteSuspension();
  void handleRequests();
  void followFormats();
  hal::Result<void> openOutputs();
  std::size_t countOpen() const;
  void offer(const Output& output);
  void followLoans();
  void takeSurfaces();
  void giveSurfacesBack();
  void close(OutputStage& output);
  void closeInPainter(Output& output);
  bool collect();
  bool collectFor(Output& output);
  void removeFinished();
  void finished(const InFlight& frame, hal::TimePoint now);
  double loadOf(const InFlight& frame, hal::TimePoint now) const;
  bool paintNewest();
  hal::Result<void> paint(const ArrivedFrame& arrived);
  bool isSpared(hal::TimePoint now) const;
  void hold(const hal::CapturedFrame& frame);
  void refuse(const ArrivedFrame& arrived, const hal::Error& error);
  void endInFlight(Outcome outcome);
  void destroyPainter();
  void lose(const hal::Error& error);
  bool revive();
  void retireIfIdle();

  PainterFactory factory_;
  std::vector<Output> outputs_;
  std::size_t nextId_ = 0;
  PaintStageOptions options_;  ///< the mutex guards its framePeriod
  hal::Clock& clock_;
  FrameLedger& ledger_;
  Mailbox<ArrivedFrame>& frames_;

  std::unique_ptr<FramePainter> painter_;
  hal::TimePoint reviveAt_;
  hal::Duration reviveAfter_;
  std::vector<InFlight> inFlight_;  ///< oldest first, at most kMaxInFlight
  /// Surfaces for the frame that is about to be painted.
  std::vector<std::pair<OutputStage*, hal::LentSurface>> taken_;
  std::optional<hal::Image> held_;  ///< the image to repeat during a pause
  hal::TimePoint lastFinished_;
  hal::TimePoint lastBegun_;  ///< when the last painting was
  hal::TimePoint lastStep_;
  hal::TimePoint resumedAt_;
  std::atomic<bool> isPaused_ = false;
  std::atomic<bool> isToRenew_ = false;
  std::atomic<std::size_t> busy_ = 0;

  enum StageIndex : std::size_t { kDelay, kWaiting, kIssuing, kFinishing, kReady };
  mutable std::mutex mutex_;  // guards the members below
  QualityGovernor governor_;
  LatencyControl latency_;
  std::array<RecentDurations, 5> stages_;
  FrameRate rate_;
  std::uint64_t painted_ = 0, failures_ = 0, contextLosses_ = 0;
  std::optional<hal::Error> failure_;
  bool hasPainter_ = false;
  bool isRenewing_ = false;
  double load_ = 0.0;
  std::vector<gpu::PassTime> passes_;
  std::optional<CameraPath> cameraPath_;
  std::vector<OutputStage*> toOpen_;   ///< requests of add()
  std::vector<OutputStage*> toClose_;  ///< requests of remove()
};

}  // namespace pleinair::runtime
