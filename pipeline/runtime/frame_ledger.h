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
  /// Frames that ended without being shown.
  std::uint64_t dropped() const;
  /// Whether captured = inFlight + sum of ended.
  bool addsUp() const;
  /// "showed 90 frames in 3.0 s (30.0 frames/s); dropped 2 (1 replaced by a newer one, …)". It has
  /// no colons, so that a caller can append text after one.
  std::string summary(hal::Duration elapsed) const;
};

/// Accounts for all captured frames: each is entered once and ends once. Any thread; allocates
/// nothing.
class FrameLedger {
 public:
  /// A frame in flight.
  struct Ticket {
    std::uint16_t slot = 0;
  };
  /// Capacity: frames in flight at a time.
  static constexpr std::size_t kMaxInFlight = 256;

  /// Enters a frame. Precondition: fewer than kMaxInFlight are in flight.
  Ticket open();
  /// Enters frames that ended before they reached the program.
  void count(Outcome outcome, std::uint64_t frames = 1);
  /// Splits a frame into parts, one for each output, that end separately. Precondition: parts >= 1.
  void split(Ticket ticket, int parts);
  /// Ends one part; the last part ends the frame, under the best outcome of all its parts (in
  /// Outcome's order). Precondition: the frame is in flight.
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
