#include "pipeline/procedure/stepper.h"

#include <cassert>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace pleinair::procedure {
namespace {

void applyParts(const Step& step, std::set<std::size_t>& off) {
  for (const std::size_t part : step.fits) off.erase(part);
  off.insert(step.removes.begin(), step.removes.end());
}

}  // namespace

std::optional<Outcome> outcomeOf(const Step& step, const Answer& answer) {
  const std::optional<CheckKind> kind = step.checkKind();
  if (std::holds_alternative<Done>(answer)) {
    return kind ? std::nullopt : std::optional(Outcome::kDone);
  }
  if (!kind) return std::nullopt;
  if (const auto* yesNo = std::get_if<YesNo>(&answer); yesNo && *kind == CheckKind::kYesNo) {
    return yesNo->isYes ? Outcome::kYes : Outcome::kNo;
  }
  if (const auto* measured = std::get_if<MeasuredValue>(&answer);
      measured && *kind == CheckKind::kValue) {
    if (!std::isfinite(measured->value)) return std::nullopt;
    if (step.check->min && measured->value < *step.check->min) return Outcome::kLow;
    if (step.check->max && measured->value > *step.check->max) return Outcome::kHigh;
    return Outcome::kOk;
  }
  if (std::holds_alternative<PhotoTaken>(answer) && *kind == CheckKind::kPhoto) {
    return Outcome::kTaken;
  }
  if (const auto* compared = std::get_if<Comparison>(&answer);
      compared && *kind == CheckKind::kCompare) {
    switch (*compared) {
      case Comparison::kPass:
        return Outcome::kPass;
      case Comparison::kFail:
        return Outcome::kFail;
      case Comparison::kUncertain:
        return Outcome::kUncertain;
    }
  }
  return std::nullopt;
}

Stepper::Stepper(std::shared_ptr<const Procedure> procedure) : procedure_(std::move(procedure)) {
  assert(procedure_ && !procedure_->steps.empty());
}

std::size_t Stepper::nextOf(Outcome outcome) const {
  assert(!isFinished());
  const auto next = step().next.find(outcome);
  return next != step().next.end() ? next->second : current_;
}

bool Stepper::advance(Outcome outcome) {
  const std::size_t next = nextOf(outcome);
  if (next == current_) return false;
  applyParts(step(), partsOff_);
  past_.push_back({.step = current_, .outcome = outcome});
  current_ = next;
  return true;
}

bool Stepper::back() {
  if (past_.empty()) return false;
  current_ = past_.back().step;
  past_.pop_back();
  // What was off before cannot be told from what is off now: a part may have been off already.
  partsOff_.clear();
  for (const PastStep& each : past_) applyParts(procedure_->steps[each.step], partsOff_);
  return true;
}

hal::Result<Stepper> Stepper::along(std::shared_ptr<const Procedure> procedure,
                                    std::span<const NamedStep> way, const std::string& current) {
  Stepper stepper(std::move(procedure));
  const auto refuse = [&](const std::string& step) {
    return tl::unexpected(hal::Error{
        .kind = hal::ErrorKind::kInvalidInput,
        .subject = stepper.procedure_->name,
        .problem = fmt::format("the way so far is not possible any more: step \"{}\"", step),
        .remedy = "the version that was begun, or another record"});
  };
  for (const NamedStep& each : way) {
    if (stepper.isFinished() || stepper.step().id != each.step || !stepper.advance(each.outcome)) {
      return refuse(each.step);
    }
  }
  if (stepName(stepper.procedure(), stepper.current_) != current) return refuse(current);
  return stepper;
}

hal::Result<Stepper> Stepper::movedTo(std::shared_ptr<const Procedure> procedure) const {
  std::vector<NamedStep> way;
  for (const PastStep& each : past_) {
    way.push_back({.step = stepName(*procedure_, each.step), .outcome = each.outcome});
  }
  return along(std::move(procedure), way, stepName(*procedure_, current_));
}

std::string stepName(const Procedure& procedure, std::size_t step) {
  return step == kEnd ? "end" : procedure.steps.at(step).id;
}

}  // namespace pleinair::procedure
