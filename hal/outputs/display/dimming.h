#pragma once

#include <optional>
#include <string_view>

#include "hal/clock.h"
#include "hal/outputs/display/blanking.h"

namespace pleinair::hal::display {

/// When a display is darker, whoever is there.
struct DimmingRules {
  std::optional<DailyTimes> times;
  double level = 0.4;  ///< of pictures then, from 0 to 1 (SurfaceOutput::brightness())

  /// "0.4"; nothing where it is no number from 0 to 1.
  static std::optional<double> parsedLevel(std::string_view text);
};

/// How bright pictures are, with fades in between. One thread.
class Dimmer {
 public:
  static constexpr Duration kFade = std::chrono::seconds(5);  ///< from 1 to the level, or back

  explicit Dimmer(DimmingRules rules) : rules_(rules) {}

  /// `timeOfDay`: nothing while it is not known; pictures are bright then. The first call shows at
  /// once what the time asks for.
  void follow(std::optional<Duration> timeOfDay, TimePoint now);
  /// From 0 to 1.
  double level(TimePoint now) const;

 private:
  DimmingRules rules_;
  std::optional<TimePoint> changedAt_;
  double from_ = 1.0;
  double to_ = 1.0;
};

}  // namespace pleinair::hal::display
