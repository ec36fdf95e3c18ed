#include "firmware_app/live/status/steady_painting.h"

#include <fstream>

#include <spdlog/spdlog.h>

namespace pleinair::app {

void SteadyPainting::update(const std::vector<OutputProgress>& outputs, hal::TimePoint now) {
  if (since_ && now - last_ > kLongestPause) since_.reset();
  if (!takePaintings(outputs)) return;
  if (!since_) since_ = now;
  last_ = now;
  if (now - *since_ >= kLasts) hasLasted_ = true;
}

/// Whether every output that can show something has shown a painting since this was last true.
bool SteadyPainting::takePaintings(const std::vector<OutputProgress>& outputs) {
  bool hasAny = false;
  for (const OutputProgress& each : outputs) {
    if (each.isExcused) continue;
    if (each.paintings <= before_[each.name]) return false;
    hasAny = true;
  }
  for (const OutputProgress& each : outputs) before_[each.name] = each.paintings;
  return hasAny;
}

void SteadyMark::update(const std::vector<OutputProgress>& outputs, hal::TimePoint now) {
  if (file_.empty() || painting_.hasLasted()) return;
  painting_.update(outputs, now);
  if (!painting_.hasLasted()) return;
  if (!std::ofstream(file_)) spdlog::warn("{} cannot be written", file_.string());
}

}  // namespace pleinair::app
