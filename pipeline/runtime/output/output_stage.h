#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "hal/output.h"
#include "pipeline/engine/painter.h"
#include "pipeline/runtime/duration_histogram.h"
#include "pipeline/runtime/frame_ledger.h"
#include "pipeline/runtime/frame_log.h"
#include "pipeline/runtime/frame_rate.h"
#include "pipeline/runtime/output/caption.h"
#include "pipeline/runtime/output/dimming.h"
#include "pipeline/runtime/output/fade_in.h"
#include "pipeline/runtime/output/presentation_queue.h"
#include "pipeline/runtime/output/surface_lending.h"

namespace pleinair::runtime {

/// Brings an output frame into a surface that the output lends, and gives the fence that signals
/// when that is done. Errors: those of the output; kUnsupported.
using SurfaceFill = std::function<hal::Result<hal::Fence>(
    const OutputFrame& frame, hal::SurfaceOutput& output, const hal::Surface& surface)>;

/// Maps a surface and copies an image of its size. Errors: those of the output;
/// hal::copyToSurface()'s.
hal::Result<hal::Fence> copyImage(const hal::ImageView& image, hal::SurfaceOutput& output,
                                  const hal::Surface& surface);
/// A SurfaceFill for the processor, by copyImage().
hal::Result<hal::Fence> copyOutputFrame(const OutputFrame& frame, hal::SurfaceOutput& output,
                                        const hal::Surface& surface);

/// Whether the frames for two outputs are alike; their refresh may differ.
bool haveSameFrames(const hal::OutputFormat& one, const hal::OutputFormat& other);

struct OutputStageOptions {
  std::string name;
  PresentationRules rules;
  /// Capacity of the queue, beside a frame that is being written: as many as fall due within the
  /// maximum latency.
  std::size_t waiting = 8;
  /// Number of frames that the output gets; later ones end as kStopped.
  std::optional<std::uint64_t> limit = std::nullopt;
  /// Fills surfaces, for an output that lends them; called on the output thread.
  SurfaceFill fill = copyOutputFrame;
  /// Opens the output again after a failure, on the output thread. Null: the first failure is
  /// final.
  std::function<hal::Result<std::unique_ptr<hal::Output>>()> reopen;
  hal::OutputRequest request;  ///< for start() after reopen()
  /// Why there is no output yet, which is waited for.
  std::optional<hal::Error> absence = std::nullopt;
  /// Lets the painter draw straight into surfaces of the output that a GPU can draw into.
  bool drawsDirectly = true;
  /// How long frames usually wait until they are shown: as many of these surfaces are needed.
  hal::Duration latency = std::chrono::milliseconds(120);
  /// Keeps the last frame that was shown, for lastFrame(); takes the memory of one.
  bool keepsLastFrame = false;
  /// Gets a record of each frame, under this number; outlives the stage. Null: none.
  FrameLog* log = nullptr;
  std::size_t logNumber = 0;
};

/// Hands frames to an output, each at its due time on the output's own refresh. It runs on an
/// output thread, so that an output that blocks delays no other. The paint thread fills buffers; if
/// the queue is full, the oldest frame in it is dropped, or the new one if even the oldest is not
/// due.
///
/// A memory output has shown a frame once write() returns. A surface-lending output has shown it
/// once a presentation event says so; until then the frame counts as waiting.
///
/// An output can show a waiting picture in place of frames, which fade in over it.
/// Where it has surfaces that a GPU draws into, in memory that is scanned out or as textures of a
/// window, the painter draws frames straight into them (SurfaceLending); frames that fade or lie
/// under a caption, those of a display that is dimmed, and those for which none is free, are
/// copied.
class OutputStage {
 public:
  /// `output` was started and answered `format`; or it is null, for OutputStageOptions::absence,
  /// and `format` stands in for its own. Ledger and clock outlive this.
  OutputStage(std::unique_ptr<hal::Output> output, hal::OutputFormat format,
              OutputStageOptions options, hal::Clock& clock, FrameLedger& ledger);

  const std::string& name() const { return options_.name; }
  /// It may be another after the output was opened again: another display. Any thread.
  hal::OutputFormat format() const;
  bool isPaced() const { return options_.rules.isPaced; }
  /// Time between refreshes of its display; unset if it has none. Any thread.
  std::optional<hal::Duration> refreshPeriod() const;

  // Paint thread.

  /// A frame for the caller to fill; the same one until submit() takes it.
  OutputFrame& buffer();
  /// Queues the filled frame, which is due `latency` after its capture. `ready`: when it was
  /// complete. `ticket`: unset for repeats during a pause.
  void submit(std::optional<FrameLedger::Ticket> ticket, hal::TimePoint ready,
              hal::Duration latency);

  /// The surfaces that the painter may draw into.
  SurfaceLending& lending() { return lending_; }
  /// One for the next frame; nothing where it is to be read back.
  std::optional<hal::LentSurface> takeSurface();

  /// Whether it is opened again after a failure.
  bool reopens() const { return options_.reopen != nullptr; }
  /// The painter cannot paint for it: it fails at the next step(). `format`: for which that is so;
  /// ignored where it has another one by now. Precondition: reopens().
  void refuse(const hal::OutputFormat& format, const hal::Error& error);
  /// Whether that was so for what it was last opened as.
  bool isRefused() const;

  // Any thread.

  /// Has `picture` (RGBA8, of format()'s size) shown as soon as no frame waits; where the output
  /// has another format, it is dropped. Only for outputs of kinds that show waiting pictures.
  /// Frames that come later fade in over it where `fades`, else replace it. It is neither a frame
  /// nor counted as one.
  void showWaiting(std::shared_ptr<const hal::Image> picture, bool fades = true);
  /// Drops a waiting picture that is not shown yet.
  void cancelWaiting();
  /// Draws a caption over each frame, and over the waiting picture that is seen, until it is
  /// called with another or null. It is no part of the frame: lastFrame() does not have it. For
  /// outputs that lend surfaces; frames are copied meanwhile.
  void setCaption(std::shared_ptr<const Caption> caption, double opacity);
  /// Has the output take another stream, at the next step(); one that fails or is absent, once it
  /// is opened.
  void reconfigure(const hal::OutputRequest& request);
  /// Whether what reconfigure() asked for is done.
  bool isReconfigured() const;
  /// A copy of the last frame that was shown whole; nothing before the first one, or without
  /// OutputStageOptions::keepsLastFrame. Where the GPU drew it into the display's memory, waits for
  /// the output thread to read it, 100 ms of real time at most; on the output thread, after
  /// refreshLastFrame().
  std::optional<hal::Image> lastFrame() const;

  // Output thread.

  /// Has lastFrame() know the last one without waiting.
  void refreshLastFrame();
  /// Hands over the frames that are due. Returns when to call again; unset while none waits.
  std::optional<hal::TimePoint> step();
  /// Returns at `time`, after wake() or submit(), or after 100 ms; waits in real time.
  void wait(std::optional<hal::TimePoint> time);
  /// Hands over the frames that are due, ends the others as kStopped, and completes what the output
  /// writes. Errors: those of hal::Output::finish(); the last failure if it was not opened again.
  hal::Result<void> finish();
  /// Destroys the output without completing it. Afterwards only destruction is allowed.
  void discard() { output_.reset(); }

  // Any thread.

  void wake();  ///< ends wait(), now or at its next call
  /// Somebody is there: a key was pressed, or something moved (hal::SurfaceOutput::noteActivity()).
  void noteActivity();
  /// Opens a failed output again at the next step(), without waiting further: a device has come.
  void retry();
  /// Whether OutputStageOptions::limit is reached.
  bool isFull() const;
  /// Whether its display is switched off.
  bool isBlanked() const;
  /// Whether all submitted frames have an outcome, and no waiting picture is on its way.
  bool isIdle() const;

  struct Status {
    std::string name;
    hal::FrameFormat format;
    std::uint64_t submitted = 0;
    std::uint64_t waiting = 0;
    std::uint64_t repeats = 0;  ///< submitted without a ticket
    std::array<std::uint64_t, kOutcomes> ended{};
    double perSecond = 0.0;
    std::uint64_t presented = 0;
    std::uint64_t waitingShown = 0;  ///< waiting pictures that a presentation event confirmed
    std::uint64_t skipped = 0;       ///< by a memory output: its reader was too slow
    std::uint64_t steps = 0;         ///< completed calls of step(): the output thread turns
    hal::Duration latencySum{0};     ///< over all presented frames
    /// Recent times from capture until write() was called; for surfaces, until they were shown.
    DurationHistogram latency;
    DurationHistogram writing;  ///< recent durations of write(), or of filling and submit()
    /// The display's refresh; its phase is the last refresh that was reported.
    std::optional<hal::Refresh> refresh;
    std::uint64_t failures = 0;
    std::uint64_t starts = 0;     ///< times that the output was opened or reconfigured
    bool isWaitingDue = false;    ///< a waiting picture is to be shown
    bool isWaitingShown = false;  ///< one was handed over, and no frame has been shown since
    bool isFailed = false;
    bool isFinal = false;               ///< failed, and will not be opened again
    std::optional<hal::Error> failure;  ///< the last one
    double brightness = 1.0;            ///< share of their values that images are shown with
    std::optional<hal::Suspension> suspension;  ///< of a display that shows nothing for now
    ScanOut scanOut;                            ///< of an output that lends surfaces
    bool addsUp() const;                        ///< submitted = waiting + sum of ended
  };
  Status status() const;

 private:
  static constexpr hal::Duration kFirstReopenDelay = std::chrono::milliseconds(500);

  struct Due {
    WaitingFrame frame;
    Outcome outcome{};
  };
  /// A frame whose surface waits for its presentation event.
  struct Queued {
    hal::SurfaceId surface{};
    WaitingFrame frame;
    /// The refresh that it is due at, by the display's count; unset where that is not known.
    std::optional<std::uint64_t> dueRefresh;
    bool isDirect = false;  ///< the GPU drew it into the surface
  };
  void handOver();
  std::optional<Due> takeDue();
  void present(const Due& due);
  hal::Answer writeFrame(hal::MemoryOutput& output, const Due& due);
  void presentInMemory(hal::MemoryOutput& output, const Due& due);
  void presentSurface(hal::SurfaceOutput& output, const Due& due);
  hal::Answer submitSurface(hal::SurfaceOutput& output, const Due& due);
  hal::Result<std::optional<hal::Surface>> fillSurface(hal::SurfaceOutput& output,
                                                       OutputFrame& frame, hal::Fence& fence);
  void followLending();
  void copyLastFrame();
  void keepLastFrame();
  void freeBuffer(std::size_t buffer);
  void takeEvents();
  void followSuspension(const hal::SurfaceOutput& output);
  void followBrightness(const hal::SurfaceOutput& output);
  Outcome outcomeWithoutSurface() const;
  void ended(const hal::PresentationEvent& event);
  Outcome outcomeOf(const hal::PresentationEvent& event, const Queued& queued) const;
  bool isOnTime(const hal::PresentationEvent& event, const Queued& queued) const;
  void countShown(const WaitingFrame& frame, hal::TimePoint time);
  void noteFilling(hal::Duration took);
  void end(const WaitingFrame& frame, Outcome outcome);
  void count(const WaitingFrame& frame, Outcome outcome, FrameRecord known = {});
  void endAll(Outcome outcome);
  void fail(hal::Error error);
  void followRefusal();
  void tryToReopen();
  void applyRequest();
  void started(const hal::OutputFormat& format);
  void presentWaiting();
  hal::Answer submitWaiting(hal::SurfaceOutput& output, const hal::Image& picture);
  hal::Result<hal::Fence> copyWaiting(const hal::Image& picture, hal::SurfaceOutput& output,
                                      const hal::Surface& surface);
  std::shared_ptr<const Caption> drawCaption(hal::Image& frame);
  void showWaitingAgain();
  bool swapDimmed(hal::Image& frame);
  void fadeIn(const Due& due);
  void retire(const WaitingFrame& frame);
  hal::Duration timeOf(const WaitingFrame& frame);

  std::unique_ptr<hal::Output> output_;
  OutputStageOptions options_;
  hal::Clock& clock_;
  FrameLedger& ledger_;
  std::optional<hal::TimePoint> firstTime_;  ///< capture time of the first frame since opening
  std::vector<std::unique_ptr<OutputFrame>> buffers_;
  std::vector<hal::PresentationEvent> events_;  ///< a member so that its memory is reused
  FadeIn fade_;
  CaptionOverlay captions_;
  hal::Image dimmed_;  ///< a frame, darker
  SurfaceLending lending_;
  bool isFaded_ = false;   ///< the frame that is being presented is not as it was painted
  bool isDirect_ = false;  ///< it was drawn into the output's surface

  mutable std::mutex mutex_;  // guards the members below
  mutable std::condition_variable changed_;
  mutable bool isWoken_ = false;
  bool isSomebodyThere_ = false;  ///< since the last step()
  hal::OutputFormat format_;
  PresentationQueue queue_;
  std::vector<std::size_t> free_;
  std::optional<std::size_t> filling_;
  std::vector<Queued> queued_;  ///< submitted surfaces without an event, oldest first
  std::optional<hal::Refresh> refresh_;
  hal::Duration fillTime_{0};  ///< the longest recent one of a surface
  bool isWriting_ = false;
  std::shared_ptr<const hal::Image> waiting_;  ///< to be shown
  bool waitingFades_ = true;
  std::shared_ptr<const hal::Image> waitingSeen_;  ///< the last one that was handed over
  std::shared_ptr<const Caption> caption_;
  double captionOpacity_ = 0.0;
  Brightness brightness_ = kFullBrightness;
  std::optional<hal::SurfaceId> waitingSurface_;  ///< submitted, without an event
  std::optional<hal::OutputRequest> request_;     ///< for applyRequest()
  bool isRefused_ = false;                        ///< until it is opened again
  std::optional<hal::Error> refusal_;             ///< for followRefusal()
  std::optional<std::size_t> last_;               ///< buffer of the last whole frame
  bool isFading_ = false;                         ///< frames are blended with a picture
  /// The surface with the last whole frame, while it is seen.
  std::optional<hal::SurfaceId> directOnScreen_;
  std::uint64_t directShown_ = 0;       ///< how many of these there were
  std::uint64_t directCopied_ = 0;      ///< directShown_ of lastCopy_
  std::optional<hal::Image> lastCopy_;  ///< of the last whole frame, where not in last_
  mutable bool isLastWanted_ = false;   ///< by lastFrame()
  mutable std::condition_variable lastCopied_;
  hal::TimePoint reopenAt_;
  hal::Duration reopenAfter_;  ///< grows until a frame is shown
  Status status_;
  FrameRate rate_;
  RecentDurations latency_;
  RecentDurations writing_;
};

}  // namespace pleinair::runtime
