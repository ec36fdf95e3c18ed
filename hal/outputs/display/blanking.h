#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "hal/clock.h"

namespace pleinair::hal::display {

/// A part of each day, by local time: from 22:00 to 08:00.
struct DailyTimes {
  Duration from{0};  ///< since midnight
  Duration to{0};    ///< not included; may be before `from`

  bool contain(Duration timeOfDay) const;
  /// "22:00-08:00"; nothing where it is not that, or both times are the same.
  static std::optional<DailyTimes> parsed(std::string_view text);
};

/// When a display is switched off. Somebody who is there keeps it on.
struct BlankingRules {
  std::optional<DailyTimes> times;  ///< then once nobody has been there for kQuiet
  std::optional<Duration> after;    ///< at any time, once nobody has been there for so long

  /// Long enough that a display is not switched off and on while somebody is there.
  static constexpr Duration kQuiet = std::chrono::minutes(1);

  /// `quiet`: for how long nobody has been there. `isInTimes`: whether it is `times` now.
  bool isOff(bool isInTimes, Duration quiet) const;
};

/// Of `blank_after`: "never" or seconds from 1 to 86400. Nothing where it is neither.
struct QuietTime {
  std::optional<Duration> after;
  static std::optional<QuietTime> parsed(std::string_view text);
};

}  // namespace pleinair::hal::display
