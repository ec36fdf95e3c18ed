#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace pleinair::runtime {

/// What became of a captured frame, best first: every one ends under exactly one of these.
enum class Fate {
  kShown,          ///< at its due time
  kShownUntimely,  ///< before or after it, lest the picture freeze
  kLate,           ///< its picture was ready too late for its due time
  kOvertaken,      ///< a newer picture fell due at the same time
  kOutputBusy,     ///< its outputs were still taking an earlier one, or skipped it for that
  kOutputFailed,   ///< its outputs took no picture
  kReplaced,       ///< a newer frame came before it was painted
  kPaused,         ///< it came during a pause
  kStarting,       ///< it came before the painter was ready
  kStopped,        ///< it was under way when all ended
  kNotPainted,     ///< the painter refused it
  kContextLost,    ///< the GPU was lost while it was painted
  kCorrupt,        ///< the camera said that it is not sound, or its planes do not hold a frame
  kIncomplete,     ///< some of it did not arrive
  kMisTimed,       ///< its capture time repeats, goes back or lies in the future
  kStarved,        ///< the camera had no free buffer for it
  kStalled,        ///< it was lost while the camera stalled
  kLeftOut,        ///< the camera, or its driver, left it out for other reasons
};
inline constexpr std::size_t kFates = 18;

/// As a name in JSON and in metrics: "shown_untimely".
std::string_view nameOf(Fate fate);
/// In a sentence after a number: "replaced by a newer one".
std::string_view describe(Fate fate);
/// All of them, in their order.
std::array<Fate, kFates> allFates();

constexpr bool isShown(Fate fate) {
  return fate == Fate::kShown || fate == Fate::kShownUntimely;
}

}  // namespace pleinair::runtime
