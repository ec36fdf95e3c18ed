#include "pipeline/record/work_session.h"

#include <cassert>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

namespace pleinair::record {
namespace {

using procedure::Procedure;
using procedure::Stepper;

hal::Error replayFault(const RecordWriter& writer, std::uint64_t line, std::string problem) {
  return {.kind = hal::ErrorKind::kInvalidInput,
          .subject = writer.path().string(),
          .problem = fmt::format("line {}: {}", line, problem),
          .remedy = "the version of the procedure that was begun, or another record"};
}

/// The steps that a record left, on the way to where it stands. Versions of the procedure may have
/// changed meanwhile: what a step led to is what the record says, not what the last version would.
struct Way {
  std::vector<procedure::NamedStep> left;
  std::string current;

  /// Follows one line; what is wrong, or nothing.
  std::string follow(const Event& event) {
    if (const auto* done = std::get_if<StepDone>(&event)) {
      if (done->step != current) {
        return fmt::format("step \"{}\" is not where the procedure stands", done->step);
      }
      if (done->next == current) return {};
      left.push_back({.step = done->step, .outcome = done->outcome});
      current = done->next;
    } else if (const auto* back = std::get_if<SteppedBack>(&event)) {
      if (left.empty() || left.back().step != back->next) {
        return fmt::format("the way back leads to another step than \"{}\"", back->next);
      }
      left.pop_back();
      current = back->next;
    }
    return {};
  }
};

}  // namespace

WorkSession::WorkSession(Stepper stepper, RecordWriter writer, std::string operatorName,
                         MomentSource clock)
    : stepper_(std::move(stepper)),
      writer_(std::move(writer)),
      operator_(std::move(operatorName)),
      clock_(std::move(clock)),
      stepBegan_(clock_()) {}

hal::Result<WorkSession> WorkSession::begin(std::shared_ptr<const Procedure> procedure,
                                            const std::filesystem::path& record, Begun begun,
                                            MomentSource clock, RecordSystem system) {
  Stepper stepper(std::move(procedure));
  begun.procedure = stepper.procedure().name;
  begun.version = stepper.procedure().version;
  begun.hash = stepper.procedure().hash;
  begun.step = stepper.step().id;
  auto writer = RecordWriter::create(record, begun, clock, std::move(system));
  if (!writer) return tl::unexpected(std::move(writer.error()));
  return WorkSession(std::move(stepper), std::move(*writer), begun.operatorName, std::move(clock));
}

hal::Result<WorkSession> WorkSession::resume(std::shared_ptr<const Procedure> procedure,
                                             const std::filesystem::path& record,
                                             const std::string& program, MomentSource clock,
                                             RecordSystem system) {
  auto writer = RecordWriter::resume(record, program, clock, std::move(system));
  if (!writer) return tl::unexpected(std::move(writer.error()));
  Way way;
  std::string operatorName;
  std::string hash;
  for (const RecordEntry& entry : writer->entries()) {
    if (const auto* begun = std::get_if<Begun>(&entry.event)) {
      if (begun->procedure != procedure->name) {
        return tl::unexpected(
            replayFault(*writer, 1, fmt::format("is of the procedure \"{}\"", begun->procedure)));
      }
      operatorName = begun->operatorName;
      hash = begun->hash;
      way.current = begun->step;
    }
    if (const auto* changed = std::get_if<OperatorChanged>(&entry.event)) {
      operatorName = changed->operatorName;
    }
    if (const auto* changed = std::get_if<ProcedureChanged>(&entry.event)) hash = changed->hash;
    if (std::string problem = way.follow(entry.event); !problem.empty()) {
      return tl::unexpected(replayFault(*writer, entry.number + 1, std::move(problem)));
    }
  }
  auto stepper = Stepper::along(std::move(procedure), way.left, way.current);
  if (!stepper) return tl::unexpected(std::move(stepper.error()));
  WorkSession session(std::move(*stepper), std::move(*writer), operatorName, std::move(clock));
  const Procedure& now = session.stepper_.procedure();
  if (now.hash != hash) {
    auto added = session.writer_.add(ProcedureChanged{.version = now.version, .hash = now.hash});
    if (!added) return tl::unexpected(std::move(added.error()));
  }
  return session;
}

hal::Result<Advance> WorkSession::answer(const procedure::Answer& answer,
                                         const std::optional<PoseQuality>& pose,
                                         const std::string& by) {
  assert(!stepper_.isFinished() && !writer_.isSignedOff());
  const procedure::Step& step = stepper_.step();
  const auto outcome = procedure::outcomeOf(step, answer);
  if (!outcome) return Advance::kRefused;
  const Moment now = clock_();
  const std::size_t next = stepper_.nextOf(*outcome);
  StepDone done{.step = step.id,
                .outcome = *outcome,
                .took = now.monotonic - stepBegan_.monotonic,
                .pose = pose,
                .by = by,
                .next = procedure::stepName(stepper_.procedure(), next)};
  if (const auto* measured = std::get_if<procedure::MeasuredValue>(&answer)) {
    done.value = measured->value;
    done.unit = step.check->unit;
  }
  if (auto added = writer_.add(std::move(done)); !added) {
    return tl::unexpected(std::move(added.error()));
  }
  stepBegan_ = now;
  return stepper_.advance(*outcome) ? Advance::kMoved : Advance::kStayed;
}

hal::Result<Advance> WorkSession::back() {
  assert(!writer_.isSignedOff());
  Stepper before = stepper_;
  if (!before.back()) return Advance::kStayed;
  const Procedure& procedure = stepper_.procedure();
  auto added = writer_.add(SteppedBack{.from = procedure::stepName(procedure, stepper_.current()),
                                       .next = procedure::stepName(procedure, before.current())});
  if (!added) return tl::unexpected(std::move(added.error()));
  stepper_ = std::move(before);
  stepBegan_ = clock_();
  return Advance::kMoved;
}

hal::Result<void> WorkSession::addStill(const std::string& when,
                                        std::span<const std::uint8_t> png) {
  assert(!stepper_.isFinished());
  return writer_.addStill(stepper_.step().id, when, png);
}

hal::Result<void> WorkSession::changeOperator(const std::string& name) {
  auto added = writer_.add(OperatorChanged{.operatorName = name});
  if (added) operator_ = name;
  return added;
}

hal::Result<void> WorkSession::changeProcedure(std::shared_ptr<const Procedure> procedure) {
  auto moved = stepper_.movedTo(std::move(procedure));
  if (!moved) return tl::unexpected(std::move(moved.error()));
  const Procedure& next = moved->procedure();
  auto added = writer_.add(ProcedureChanged{.version = next.version, .hash = next.hash});
  if (added) stepper_ = std::move(*moved);
  return added;
}

hal::Result<void> WorkSession::signOff(const std::string& remark) {
  assert(!writer_.isSignedOff());
  return writer_.add(
      SignedOff{.result = stepper_.isFinished() ? SignOff::kCompleted : SignOff::kAborted,
                .operatorName = operator_,
                .remark = remark});
}

}  // namespace pleinair::record
