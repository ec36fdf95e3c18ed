#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <string>

#include "hal/clock.h"
#include "pipeline/runtime/outcome.h"

namespace pleinair::runtime {

/// How many frames were captured, how many are in flight, and how the others ended.
struct LedgerCounts {
  std::uint64_t captured = 0;
  std::uint64_t inFlight = 0;
  std::array<std::uint64_t, kOutcomes> ended{};

  std::uint64_t of(Outcome outcome) const { return ended.at(static_cast<std::size_t>(outcome)); }
  std::uint64_t shown() const { return of(Outcome::kShown) + of(Outcome::kShownOffSchedule); }
  /// Ended without having been shown.
  std::uint64_t dropped() const;
  /// Whether captured = inFlight + all that ended.
  bool addsUp() const;
  /// "showed 90 frames in 3.0 s (30.0 frames/s); dropped 2 (1 replaced by a newer one, …)": without
  /// colons, so that what follows one is no part of it.
  std::string summary(hal::Duration elapsed) const;
};

/// The book of frames: each that was captured is entered once and ends once. Thread-safe; allocates
/// nothing.
class FrameLedger {
 public:
  /// A frame in flight.
  struct Ticket {
    std::uint16_t slot = 0;
  };
  /// How many can be in flight at a time.
  static constexpr std::size_t kMaxInFlight = 256;

  /// Enters a frame. Precondition: fewer than kMaxInFlight are in flight.
  Ticket open();
  /// Enters frames that ended before we had them.
  void count(Outcome outcome, std::uint64_t frames = 1);
  /// From now on the frame has so many parts, each of which ends by itself; at least one.
  void split(Ticket ticket, int parts);
  /// Ends the frame, or one of its parts; the last part ends the frame, under the best outcome of
  /// all (Outcome's order). Precondition: it is in flight.
  void end(Ticket ticket, Outcome outcome);

  LedgerCounts counts() const;

 private:
  struct Slot {
    int parts = 0;  ///< 0: free
    Outcome best{};
    bool hasOutcome = false;
  };
  Slot& at(Ticket ticket);

  mutable std::mutex mutex_;
  LedgerCounts counts_;
  std::array<Slot, kMaxInFlight> slots_{};
  std::size_t next_ = 0;  ///< where the search for a free slot begins
};

}  // namespace pleinair::runtime
