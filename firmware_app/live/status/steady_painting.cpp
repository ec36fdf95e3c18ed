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

/// Whether every output that can show something, and is read, has shown a painting since this was
/// last true.
bool SteadyPainting::takePaintings(const std::vector<OutputProgress>& outputs) {
  bool hasAny = false;
  for (const OutputProgress& each : outputs) {
    const OutputProgress& then = before_[each.name];
    if (each.isExcused || each.skipped > then.skipped) continue;
    if (each.paintings <= then.paintings) return false;
    hasAny = true;
  }
  for (const OutputProgress& each : outputs) before_[each.name] = each;
  return hasAny;
}

void SteadyMark::update(const std::vector<OutputProgress>& outputs, hal::TimePoint now) {
  if (file_.empty() || painting_.hasLasted()) return;
  painting_.update(outputs, now);
  if (!painting_.hasLasted()) return;
  if (!std::ofstream(file_)) spdlog::warn("{} cannot be written", file_.string());
}

}  // namespace pleinair::app
