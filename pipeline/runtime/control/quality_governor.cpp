#include "pipeline/runtime/control/quality_governor.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <span>

#include "hal/median.h"

namespace pleinair::runtime {
namespace {

/// Assumed ratio of loads of adjacent levels, until it has been measured.
constexpr double kUsualRatio = 1.5;
/// A rise that lasts for so long was right.
constexpr hal::Duration kProof = std::chrono::seconds(10);
/// Above this load a few frames are enough to lower quality …
constexpr double kClearlyOverBudget = 1.25;
/// … and above this load it is lowered by two levels.
constexpr double kFarOverBudget = 1.9;
/// The weight of a measured ratio halves in this time: another program may have caused the load.
constexpr double kRatioHalfLifeSeconds = 60.0;

}  // namespace

QualityGovernor::QualityGovernor(GovernorRules rules)
    : rules_(rules),
      level_(rules.pinned.value_or(0)),
      learnt_(rules.levels, {kUsualRatio, hal::TimePoint{}}),
      raiseAfter_(rules.raiseAfter) {
  assert(rules.levels > 0 && level_ < rules.levels);
}

bool QualityGovernor::painted(double load, std::size_t level, hal::TimePoint now) {
  // Frames in flight at a change were painted at the previous level.
  if (rules_.pinned || level != level_) return false;
  if (seen_ == 0) fitsSince_ = now;
  recent_.at(seen_ % kWindow) = load;
  // A single slow frame must not dominate the mean.
  const double counted = std::min(load, 2.0);
  const double share = std::max(0.1, 1.0 / static_cast<double>(seen_ + 1));
  smooth_ += share * (counted - smooth_);
  ++seen_;
  if (seen_ == kWindow) learnRatio(now);
  if (raisedAt_ && now - *raisedAt_ >= kProof) {
    raisedAt_.reset();
    raiseAfter_ = std::max(raiseAfter_ / 2, rules_.raiseAfter);
  }
  if (level_ + 1 < rules_.levels && isOverBudget()) {
    lower(now);
    return true;
  }
  if (level_ > best_ && mayRaise(now)) {
    raise(now);
    return true;
  }
  return false;
}

void QualityGovernor::limit(std::size_t best, hal::TimePoint now) {
  if (rules_.pinned) return;
  best_ = std::min(best, rules_.levels - 1);
  if (level_ >= best_) return;
  ++lowered_;
  change(best_, now);
}

bool QualityGovernor::isOverBudget() const {
  const auto filled = recent_.begin() + static_cast<std::ptrdiff_t>(std::min(seen_, kWindow));
  const auto slow =
      std::count_if(recent_.begin(), filled, [](double load) { return load > kClearlyOverBudget; });
  if (static_cast<std::size_t>(slow) >= kEnough) return true;
  return seen_ >= 2 * kWindow && smooth_ > rules_.lowerAbove;
}

double QualityGovernor::median() const {
  std::array<double, kWindow> loads = recent_;
  return hal::medianOf(std::span(loads).first(std::min(seen_, kWindow)));
}

/// Measures the ratio of loads once a lowered level has run for a few frames.
void QualityGovernor::learnRatio(hal::TimePoint now) {
  if (!loadBefore_) return;
  constexpr double kMinRatio = 1.05;
  constexpr double kMaxRatio = 4.0;
  const double ratio = std::clamp(*loadBefore_ / std::max(median(), 0.01), kMinRatio, kMaxRatio);
  learnt_.at(level_ - 1) = {ratio, now};
  loadBefore_.reset();
}

double QualityGovernor::ratioAbove(hal::TimePoint now) const {
  const Learnt& learnt = learnt_.at(level_ - 1);
  const double age = hal::toSeconds(now - learnt.at);
  return kUsualRatio + (learnt.ratio - kUsualRatio) * std::exp2(-age / kRatioHalfLifeSeconds);
}

bool QualityGovernor::mayRaise(hal::TimePoint now) {
  const double expected = std::max(smooth_, median()) * ratioAbove(now);
  if (expected > rules_.raiseBelow) fitsSince_ = now;
  return seen_ >= kWindow && now - fitsSince_ >= raiseAfter_;
}

void QualityGovernor::lower(hal::TimePoint now) {
  const double load = median();
  if (raisedAt_) {
    raiseAfter_ = std::min(raiseAfter_ * 2, rules_.maxRaiseAfter);
    raisedAt_.reset();
  }
  const std::size_t steps = load > kFarOverBudget && level_ + 2 < rules_.levels ? 2 : 1;
  ++lowered_;
  change(level_ + steps, now);
  if (steps == 1) loadBefore_ = load;
}

void QualityGovernor::raise(hal::TimePoint now) {
  ++raised_;
  change(level_ - 1, now);
  raisedAt_ = now;
}

void QualityGovernor::change(std::size_t level, hal::TimePoint now) {
  level_ = level;
  seen_ = 0;
  smooth_ = 0.0;
  loadBefore_.reset();
  fitsSince_ = now;
}

}  // namespace pleinair::runtime
