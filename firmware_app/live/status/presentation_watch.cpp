#include "firmware_app/live/status/presentation_watch.h"

#include <algorithm>
#include <utility>

namespace pleinair::app {

OutputProgress progressOf(const runtime::OutputStage::Status& output, bool isScreen) {
  return {.name = output.name,
          .shown = output.presented + output.waitingShown,
          .paintings = output.presented,
          .skipped = output.skipped,
          .submitted = output.submitted,
          .steps = output.steps,
          .isExcused = output.isFailed || output.suspension.has_value(),
          .isScreen = isScreen};
}

void PresentationWatch::update(Seen seen, hal::TimePoint now) {
  const bool hasPainted = seen.painted != painted_;
  if (hasPainted || !seen.expectsPaintings) arrivedBefore_ = seen.arrived;
  waitsForTrigger_ = seen.expectsPaintings && seen.isTriggered && seen.arrived == arrivedBefore_;
  if (hasPainted || !seen.expectsPaintings || waitsForTrigger_) paintedAt_ = now;
  painted_ = seen.painted;
  seen_ = std::move(seen);
  now_ = now;
}

bool PresentationWatch::hasShown() const {
  return std::ranges::any_of(
      seen_.outputs, [](const OutputProgress& each) { return each.shown + each.skipped > 0; });
}

bool PresentationWatch::hasAdvanced(const OutputProgress& output) const {
  const auto before = before_.find(output.name);
  if (before == before_.end()) return true;
  const OutputProgress& then = before->second;
  if (output.shown > then.shown || output.skipped > then.skipped) return true;
  const bool isIdle = (!output.isScreen || waitsForTrigger_) && output.submitted == then.submitted;
  return (output.isExcused || isIdle) && output.steps > then.steps;
}

bool PresentationWatch::takeProgress() {
  if (seen_.outputs.empty() || now_ - paintedAt_ > kPaintPatience) return false;
  const bool haveAll = std::ranges::all_of(
      seen_.outputs, [this](const OutputProgress& each) { return hasAdvanced(each); });
  if (!haveAll) return false;
  for (const OutputProgress& each : seen_.outputs) before_[each.name] = each;
  return true;
}

}  // namespace pleinair::app
