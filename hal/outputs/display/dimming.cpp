#include "hal/outputs/display/dimming.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace pleinair::hal::display {

std::optional<double> DimmingRules::parsedLevel(std::string_view text) {
  double level = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), level);
  const bool isWhole = read.ec == std::errc() && read.ptr == text.data() + text.size();
  if (!isWhole || !(level >= 0.0 && level <= 1.0)) return std::nullopt;
  return level;
}

void Dimmer::follow(std::optional<Duration> timeOfDay, TimePoint now) {
  const bool isDim = timeOfDay && rules_.times && rules_.times->contain(*timeOfDay);
  const double wanted = isDim ? rules_.level : 1.0;
  if (changedAt_ && wanted == to_) return;
  from_ = changedAt_ ? level(now) : wanted;
  to_ = wanted;
  changedAt_ = now;
}

double Dimmer::level(TimePoint now) const {
  if (!changedAt_) return to_;
  const double t = std::clamp(toSeconds(now - *changedAt_) / toSeconds(kFade), 0.0, 1.0);
  return std::lerp(from_, to_, t);
}

}  // namespace pleinair::hal::display
