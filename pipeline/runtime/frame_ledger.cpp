#include "pipeline/runtime/frame_ledger.h"

#include <cassert>
#include <chrono>
#include <numeric>

#include <fmt/format.h>

namespace pleinair::runtime {

std::uint64_t LedgerCounts::dropped() const {
  return std::accumulate(ended.begin(), ended.end(), std::uint64_t{0}) - shown();
}

bool LedgerCounts::addsUp() const {
  return captured == inFlight + shown() + dropped();
}

std::string LedgerCounts::summary(hal::Duration elapsed) const {
  const double seconds = hal::toSeconds(elapsed);
  const double rate = seconds > 0.0 ? static_cast<double>(shown()) / seconds : 0.0;
  std::string text = fmt::format("showed {} {} in {:.1f} s ({:.1f} frames/s)", shown(),
                                 shown() == 1 ? "frame" : "frames", seconds, rate);
  const std::uint64_t offSchedule = of(Outcome::kShownOffSchedule);
  if (offSchedule > 0) text += fmt::format(", {} off schedule", offSchedule);
  text += fmt::format("; dropped {}", dropped());
  const char* separator = " (";
  for (const Outcome outcome : allOutcomes()) {
    if (isShown(outcome) || of(outcome) == 0) continue;
    text += fmt::format("{}{} {}", separator, of(outcome), describe(outcome));
    separator = ", ";
  }
  if (dropped() > 0) text += ')';
  return text;
}

FrameLedger::Ticket FrameLedger::open() {
  const std::scoped_lock lock(mutex_);
  assert(counts_.inFlight < kMaxInFlight);
  while (slots_.at(next_).parts != 0) next_ = (next_ + 1) % kMaxInFlight;
  slots_.at(next_) = {.parts = 1};
  ++counts_.captured;
  ++counts_.inFlight;
  return {static_cast<std::uint16_t>(next_)};
}

void FrameLedger::count(Outcome outcome, std::uint64_t frames) {
  const std::scoped_lock lock(mutex_);
  counts_.captured += frames;
  counts_.ended.at(static_cast<std::size_t>(outcome)) += frames;
}

FrameLedger::Slot& FrameLedger::at(Ticket ticket) {
  Slot& slot = slots_.at(ticket.slot);
  assert(slot.parts > 0);
  return slot;
}

void FrameLedger::split(Ticket ticket, int parts) {
  assert(parts >= 1);
  const std::scoped_lock lock(mutex_);
  at(ticket).parts = parts;
}

void FrameLedger::end(Ticket ticket, Outcome outcome) {
  const std::scoped_lock lock(mutex_);
  Slot& slot = at(ticket);
  if (!slot.hasOutcome || outcome < slot.best) slot.best = outcome;
  slot.hasOutcome = true;
  if (--slot.parts > 0) return;
  --counts_.inFlight;
  ++counts_.ended.at(static_cast<std::size_t>(slot.best));
}

LedgerCounts FrameLedger::counts() const {
  const std::scoped_lock lock(mutex_);
  return counts_;
}

}  // namespace pleinair::runtime
