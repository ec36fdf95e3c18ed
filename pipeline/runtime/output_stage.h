#pragma once

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
#include "pipeline/runtime/frame_rate.h"
#include "pipeline/runtime/presentation_queue.h"

namespace pleinair::runtime {

/// As OutputStageOptions::fill. Errors: those of the output; kUnsupported.
using SurfaceFill = std::function<hal::Result<hal::Fence>(
    const OutputFrame& picture, hal::SurfaceOutput& output, const hal::Surface& surface)>;

/// Maps the surface and copies the picture.
hal::Result<hal::Fence> copyPicture(const OutputFrame& picture, hal::SurfaceOutput& output,
                                    const hal::Surface& surface);

struct OutputStageOptions {
  std::string name;
  PresentationRules rules;
  /// How many pictures can wait, beside one that is being taken: as many as fall due within the
  /// longest latency.
  std::size_t waiting = 8;
  /// How many it gets; what comes after them ends as kStopped.
  std::optional<std::uint64_t> limit = std::nullopt;
  /// Brings a picture into a surface that the output lends, and gives the fence behind that work.
  /// By default the processor copies it (hal::copyToSurface()); a painter on the GPU draws it
  /// there. Of outputs that lend surfaces; on the output thread.
  SurfaceFill fill = copyPicture;
  /// Opens the output anew after it has failed, on the output thread; without, that is the end of
  /// it. It has to take the same format again.
  std::function<hal::Result<std::unique_ptr<hal::Output>>()> reopen;
  hal::OutputRequest request;  ///< what it was started with
};

/// Hands pictures to an output, each at its due time on the output's own refresh. It has a thread
/// of its own, so that an output that stalls holds up no other. The paint thread fills buffers;
/// where too many pictures wait, one gives way: the oldest, unless even that is still to come.
///
/// An output in memory has shown a picture once it has taken it. An output that lends surfaces has
/// shown it once its presentation event says so: until then the picture counts as waiting.
class OutputStage {
 public:
  /// `output` was started and answered `format`. Ledger and clock outlive this.
  OutputStage(std::unique_ptr<hal::Output> output, hal::OutputFormat format,
              OutputStageOptions options, hal::Clock& clock, FrameLedger& ledger);

  const std::string& name() const { return options_.name; }
  const hal::OutputFormat& format() const { return format_; }
  bool isPaced() const { return options_.rules.isPaced; }
  /// The period of its refresh, where it has one. Any thread.
  std::optional<hal::Duration> refreshPeriod() const;

  // Paint thread.

  /// A picture to be filled, which belongs to the caller until submit() or a second call.
  OutputFrame& buffer();
  /// Takes that picture, which is due `latency` after its capture. `ticket`: none for repeats.
  void submit(std::optional<FrameLedger::Ticket> ticket, hal::TimePoint ready,
              hal::Duration latency);

  // Output thread.

  /// Hands over what is due. When to call again at the latest: none while nothing waits.
  std::optional<hal::TimePoint> step();
  /// Until `time`, wake() or submit(); by the clock's real time.
  void wait(std::optional<hal::TimePoint> time);
  /// Hands over what is due, ends what is not as kStopped, and completes what the output writes.
  /// Errors: that of the output; the last one where it has failed and was not opened again.
  hal::Result<void> finish();
  /// Lets go of the output without completing it; only destruction is allowed then.
  void discard() { output_.reset(); }

  // Any thread.

  void wake();
  /// Whether it has got as many as it may.
  bool isFull() const;
  /// Whether all that was submitted has ended.
  bool isIdle() const;

  struct Status {
    std::string name;
    hal::FrameFormat format;
    std::uint64_t submitted = 0;
    std::uint64_t waiting = 0;
    std::uint64_t repeats = 0;  ///< of those submitted: without a frame of their own
    std::array<std::uint64_t, kOutcomes> ended{};
    double perSecond = 0.0;
    std::uint64_t presented = 0;
    hal::Duration latencySum{0};  ///< of all that were presented
    /// Recent times from capture to being handed over; for surfaces, to being shown.
    DurationHistogram latency;
    DurationHistogram writing;  ///< how long the output took, of late
    /// The refresh of a display, with the time of the last one that is known.
    std::optional<hal::Refresh> refresh;
    std::uint64_t failures = 0;
    bool isFailed = false;
    bool isFinal = false;               ///< and will not be opened again
    std::optional<hal::Error> failure;  ///< the last
    bool addsUp() const;
  };
  Status status() const;

 private:
  struct Due {
    WaitingPicture picture;
    Outcome outcome{};
  };
  /// A picture whose surface waits for its presentation event.
  struct Queued {
    hal::SurfaceId surface{};
    WaitingPicture picture;
  };
  void handOver();
  std::optional<Due> takeDue();
  void present(const Due& due);
  void presentInMemory(hal::MemoryOutput& output, const Due& due);
  void presentSurface(hal::SurfaceOutput& output, const Due& due);
  hal::Answer submitSurface(hal::SurfaceOutput& output, const Due& due);
  void takeEvents();
  void ended(const hal::PresentationEvent& event);
  Outcome outcomeOf(const hal::PresentationEvent& event, const Queued& queued) const;
  void countShown(const WaitingPicture& picture, hal::TimePoint time);
  void end(const WaitingPicture& picture, Outcome outcome);
  void count(const WaitingPicture& picture, Outcome outcome);
  void endAll(Outcome outcome);
  void fail(hal::Error error);
  void tryToReopen();
  hal::Duration timeOf(const WaitingPicture& picture);

  std::unique_ptr<hal::Output> output_;
  hal::OutputFormat format_;
  OutputStageOptions options_;
  hal::Clock& clock_;
  FrameLedger& ledger_;
  std::optional<hal::TimePoint> firstTime_;  ///< of what the output has got
  hal::Duration reopenAfter_;                ///< grows until a picture is taken
  std::vector<std::unique_ptr<OutputFrame>> buffers_;
  std::vector<hal::PresentationEvent> events_;  ///< kept for its memory

  mutable std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  bool isWoken_ = false;
  PresentationQueue queue_;
  std::vector<std::size_t> free_;
  std::optional<std::size_t> filling_;
  std::vector<Queued> queued_;  ///< surfaces without an event yet, oldest first
  std::optional<hal::Refresh> refresh_;
  bool isWriting_ = false;
  hal::TimePoint reopenAt_;
  Status status_;
  FrameRate rate_;
  RecentDurations latency_;
  RecentDurations writing_;
};

}  // namespace pleinair::runtime
