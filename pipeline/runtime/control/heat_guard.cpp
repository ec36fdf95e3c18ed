#include "pipeline/runtime/control/heat_guard.h"

#include <algorithm>

namespace pleinair::runtime {

bool HeatGuard::update(std::optional<double> marginKelvin, std::size_t level, hal::TimePoint now) {
  if (rules_.marginKelvin <= 0.0) return false;
  if (marginKelvin && *marginKelvin < rules_.marginKelvin) {
    coolSince_.reset();
    return tooHot(level, now);
  }
  hotSince_.reset();
  if (!marginKelvin || *marginKelvin >= rules_.marginKelvin + rules_.releaseKelvin)
    return cool(now);
  coolSince_.reset();
  return false;
}

bool HeatGuard::tooHot(std::size_t level, hal::TimePoint now) {
  if (!hotSince_) hotSince_ = now;
  if (now - *hotSince_ < rules_.lowerAfter) return false;
  hotSince_ = now;
  isHot_ = true;
  const std::size_t lowest = rules_.levels - 1;
  const std::size_t best = std::min(std::max(best_, level) + 1, lowest);
  const bool changes = best != best_;
  best_ = best;
  return changes;
}

bool HeatGuard::cool(hal::TimePoint now) {
  if (!isHot_) return false;
  if (!coolSince_) coolSince_ = now;
  if (now - *coolSince_ < rules_.raiseAfter) return false;
  coolSince_ = now;
  const bool changes = best_ > 0;
  if (changes) --best_;
  isHot_ = best_ > 0;
  return changes;
}

}  // namespace pleinair::runtime
