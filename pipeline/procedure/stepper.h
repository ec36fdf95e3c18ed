#pragma once

#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "hal/error.h"
#include "pipeline/procedure/procedure.h"

namespace pleinair::procedure {

// What somebody answers to a step.

struct Done {};
struct YesNo {
  bool isYes = false;
};
/// In the check's unit.
struct MeasuredValue {
  double value = 0.0;
};
struct PhotoTaken {};
enum class Comparison { kPass, kFail, kUncertain };
using Answer = std::variant<Done, YesNo, MeasuredValue, PhotoTaken, Comparison>;

/// The outcome of an answer to a step; nothing if the step asks for another kind of answer, or for
/// a value that is no number.
std::optional<Outcome> outcomeOf(const Step& step, const Answer& answer);

/// A step that was ended.
struct PastStep {
  std::size_t step = 0;
  Outcome outcome = Outcome::kDone;
};

/// The same, by the step's id, which other versions of the procedure have, too.
struct NamedStep {
  std::string step;
  Outcome outcome = Outcome::kDone;
};

/// Where a running procedure stands: the current step, the way to it, and what is off the machine.
/// No clock, no files, no user interface. A value; one thread at a time.
class Stepper {
 public:
  /// At the first step. `procedure` has at least one.
  explicit Stepper(std::shared_ptr<const Procedure> procedure);

  const Procedure& procedure() const { return *procedure_; }
  const std::shared_ptr<const Procedure>& procedurePointer() const { return procedure_; }
  bool isFinished() const { return current_ == kEnd; }
  /// Index of the current step, or kEnd.
  std::size_t current() const { return current_; }
  /// Precondition: !isFinished().
  const Step& step() const { return procedure_->steps[current_]; }
  const std::vector<PastStep>& past() const { return past_; }
  /// Parts that are off when the current step begins.
  const std::set<std::size_t>& partsOff() const { return partsOff_; }

  /// Where an outcome of the current step leads: the same step where it keeps it. Precondition:
  /// !isFinished(), and an outcome of the step's kind.
  std::size_t nextOf(Outcome outcome) const;
  /// Ends the current step. Preconditions as for nextOf(). Returns whether the step was left.
  bool advance(Outcome outcome);
  /// Goes back to the step before on the way, from the end too. False at the first step.
  bool back();

  /// At the end of a way, of steps that were left, which leads to the step `current` ("end"). Error
  /// (kInvalidInput): one of them is not there, or leads elsewhere.
  static hal::Result<Stepper> along(std::shared_ptr<const Procedure> procedure,
                                    std::span<const NamedStep> way, const std::string& current);
  /// The same way through another version of the procedure, matched by ids. Error: that of along().
  hal::Result<Stepper> movedTo(std::shared_ptr<const Procedure> procedure) const;

 private:
  std::shared_ptr<const Procedure> procedure_;
  std::size_t current_ = 0;
  std::vector<PastStep> past_;  // only steps that were left, on the way to the current one
  std::set<std::size_t> partsOff_;
};

/// The id of a step, or "end".
std::string stepName(const Procedure& procedure, std::size_t step);

}  // namespace pleinair::procedure
