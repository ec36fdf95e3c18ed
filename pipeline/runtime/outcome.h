#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace pleinair::runtime {

/// How a captured frame ended, best first. Each frame has exactly one outcome.
enum class Outcome {
  kShown,             ///< at its due time
  kShownOffSchedule,  ///< before or after its due time, so that the display does not freeze
  kLate,              ///< it was ready too late for its due time
  kSuperseded,        ///< a newer frame fell due at the same time
  kOutputBusy,        ///< its outputs were busy with an earlier one
  kNoSurface,         ///< its outputs had no free surface for it
  kSuspended,         ///< another console or program had its outputs' displays
  kBlanked,           ///< its outputs' displays were switched off
  kOutputFailed,      ///< its outputs had failed
  kReplaced,          ///< a newer frame came before it was painted: the painter was too slow
  kPaused,            ///< it came during a pause
  kStarting,          ///< it came before the painter was ready
  kStopped,           ///< it was in flight when the program or the output ended
  kNotPainted,        ///< the painter refused it
  kContextLost,       ///< the GPU was lost while it was painted
  kCorrupt,           ///< marked as faulty by the camera, or its planes are too small
  kIncomplete,        ///< some of it did not arrive
  kMisTimed,          ///< its capture time repeats, goes back or lies in the future
  kBufferUnderrun,    ///< the camera had no free buffer for it
  kStalled,           ///< it was lost while the camera stalled
  kDroppedByDriver,   ///< the camera or its driver dropped it for another reason
};
inline constexpr std::size_t kOutcomes = 21;

/// The name in JSON and metrics: "shown_off_schedule".
std::string_view nameOf(Outcome outcome);
/// Words that follow a number in a sentence: "replaced by a newer one".
std::string_view describe(Outcome outcome);
/// All of them, in their order.
std::array<Outcome, kOutcomes> allOutcomes();

constexpr bool isShown(Outcome outcome) {
  return outcome == Outcome::kShown || outcome == Outcome::kShownOffSchedule;
}

}  // namespace pleinair::runtime
