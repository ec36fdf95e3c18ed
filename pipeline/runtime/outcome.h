#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace pleinair::runtime {

/// What became of a captured frame, best first: every one ends under exactly one of these.
enum class Outcome {
  kShown,             ///< at its due time
  kShownOffSchedule,  ///< before or after it, lest the picture freeze
  kLate,              ///< its picture was ready too late for its due time
  kSuperseded,        ///< a newer picture fell due at the same time
  kOutputBusy,        ///< its outputs were still taking an earlier one, or skipped it for that
  kNoSurface,         ///< its outputs had no free surface for it
  kOutputFailed,      ///< its outputs took no picture
  kReplaced,          ///< a newer frame came before it was painted: the painter was too slow
  kPaused,            ///< it came during a pause
  kStarting,          ///< it came before the painter was ready
  kStopped,           ///< it was in flight when all ended
  kNotPainted,        ///< the painter refused it
  kContextLost,       ///< the GPU was lost while it was painted
  kCorrupt,           ///< the camera said that it is not sound, or its planes do not hold a frame
  kIncomplete,        ///< some of it did not arrive
  kMisTimed,          ///< its capture time repeats, goes back or lies in the future
  kBufferUnderrun,    ///< the camera had no free buffer for it
  kStalled,           ///< it was lost while the camera stalled
  kDroppedByDriver,   ///< the camera, or its driver, left it out for other reasons
};
inline constexpr std::size_t kOutcomes = 19;

/// As a name in JSON and in metrics: "shown_off_schedule".
std::string_view nameOf(Outcome outcome);
/// In a sentence after a number: "replaced by a newer one".
std::string_view describe(Outcome outcome);
/// All of them, in their order.
std::array<Outcome, kOutcomes> allOutcomes();

constexpr bool isShown(Outcome outcome) {
  return outcome == Outcome::kShown || outcome == Outcome::kShownOffSchedule;
}

}  // namespace pleinair::runtime
