#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/output.h"
#include "hal/outputs/display/display_pipe.h"
#include "hal/surface.h"

namespace pleinair::hal::display {

/// The pictures on their way to a display: queued until their refresh is next, flipping until the
/// card's event says when they were shown, on the screen until another is. It owns the display's
/// refresh: period and phase are those of its flips. Allocates in begin() only. One thread.
class FlipQueue {
 public:
  /// Both outlive it.
  FlipQueue(DisplayPipe& pipe, const Clock& clock) : pipe_(pipe), clock_(clock) {}

  /// The mode was set, with this buffer on the screen.
  void begin(DisplayBuffer& shown);
  /// The mode in force was set anew: another phase.
  void readTiming();
  /// Follows the refreshes while there are no flips, about once a second.
  void followRefresh();

  /// Queues a buffer that was lent.
  void push(DisplayBuffer& buffer, Fence fence, TimePoint due);
  /// Takes the card's events. 0, or −errno.
  int takeFlips();
  /// Commits the newest of the buffers whose refresh is next, up to the first that is not ready;
  /// one that is alone, with its fence, if the card waits for that itself. 0, or −errno: EACCES
  /// (not the master), and what says that the card is gone. A busy card is asked again; a picture
  /// that it has no memory for is skipped, and so is one of a GPU's that it refuses.
  int commitNext(TimePoint now);

  /// Ends the queued buffers as kSkipped; one that is flipping may still be shown.
  void skipQueued(TimePoint now);
  /// Ends the one that is flipping as kSkipped: its event will not come.
  void skipFlipping(TimePoint now);

  bool isFlipping() const { return flipping_ != nullptr; }
  /// Whether a flip takes longer than any display does.
  bool isOverdue(TimePoint now) const;
  /// The one on the screen; null before begin().
  const DisplayBuffer* onScreen() const { return onScreen_; }
  /// What is on the screen is black from then on; another buffer may be in its place.
  void blackenScreen();
  /// Whether the card has refused to flip to a buffer of a GPU, once.
  bool takeGpuRefusal() { return std::exchange(isGpuRefused_, false); }

  Refresh refresh() const;
  /// Moves the events since the last call to the end of `events`.
  void takeEvents(std::vector<PresentationEvent>& events);
  /// When to call takeFlips() and commitNext() next; unset where nothing is on its way.
  std::optional<TimePoint> nextEvent() const;

 private:
  struct Queued {
    DisplayBuffer* buffer = nullptr;
    Fence fence;
    TimePoint due;
  };
  bool isReady(const Queued& queued, TimePoint now) const;
  void flipped(const FlipEvent& flip);
  TimePoint commitTime(const Queued& queued) const;
  void end(DisplayBuffer& buffer, PresentationEvent::Result result, TimePoint time);
  std::uint64_t extended(std::uint32_t sequence);

  DisplayPipe& pipe_;
  const Clock& clock_;

  bool hasVblank_ = false;
  Duration period_{0};
  TimePoint phase_;                 ///< the last refresh that is known
  std::uint64_t lastSequence_ = 0;  ///< its number

  std::vector<Queued> queue_;  ///< the earliest first
  bool isGpuRefused_ = false;
  DisplayBuffer* flipping_ = nullptr;
  DisplayBuffer* onScreen_ = nullptr;
  TimePoint committed_;  ///< flipping_
  TimePoint retryAt_;    ///< where the card was busy
  std::optional<TimePoint> busySince_;
  std::vector<FlipEvent> flips_;
  std::vector<PresentationEvent> events_;
};

}  // namespace pleinair::hal::display
