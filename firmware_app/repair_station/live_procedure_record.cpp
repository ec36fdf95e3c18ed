// What a procedure gives to the thread that writes its record, and what follows.
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "firmware_app/repair_station/live_procedure.h"
#include "firmware_app/repair_station/still_comparison.h"
#include "pipeline/procedure/procedure_file.h"
#include "pipeline/procedure/words.h"

namespace pleinair::app {
namespace {

using Advanced = hal::Result<record::Advance>;

}  // namespace

void LiveProcedure::beginMove() {
  moves_ = true;
  moved_ = clock_.now();
  moveSource_ = source_;
  asked_.reset();
}

/// Gives what ends, leaves or signs off: until it is done, nothing else of that kind is taken.
void LiveProcedure::giveMove(StepWorker::Job job) {
  beginMove();
  worker_->give(std::move(job), [this](const std::string& problem) {
    moves_ = false;
    fail(procedure::filled(notices().notRecorded, problem));
  });
}

/// Gives what leaves the step as it is.
void LiveProcedure::giveAside(StepWorker::Job job) {
  worker_->give(std::move(job), [this](const std::string& problem) {
    fail(procedure::filled(notices().notRecorded, problem));
  });
}

void LiveProcedure::commit(const procedure::Answer& answer, const std::string& by) {
  typed_.clear();
  mayJudge_ = false;
  const auto outcome = procedure::outcomeOf(stepper().step(), answer);
  if (!outcome) return;
  giveMove([this, answer, by, outcome = *outcome, pose = poseNow(), step = stepper().step().id,
            version = stepper().procedurePointer()](StepSession& session) -> StepWorker::Then {
    const auto advance = session.isAt(step, *version) ? session.answer(answer, pose, by)
                                                      : Advanced(record::Advance::kRefused);
    return [this, advance, outcome] { endMove(advance, outcome); };
  });
}

/// An answer is on the disk, or has failed. `isTold`: the caller says why the step stays.
void LiveProcedure::endMove(const hal::Result<record::Advance>& advance, procedure::Outcome outcome,
                            bool isTold) {
  moves_ = false;
  if (!advance) return noteFailure(advance.error(), Unwritten::kAnswer);
  // The thread had read another version before: nobody has seen its text and limits.
  if (*advance == record::Advance::kRefused) return note(notices().wasEdited);
  moved_ = clock_.now();
  typed_.clear();
  if (*advance == record::Advance::kStayed) {
    if (isTold) return;
    note(procedure::filled(notices().doAgain,
                           procedure::wordOf(procedure::wordsIn(options_.language), outcome)));
    return;
  }
  if (isRecorded() && options_.stillsOfSteps && !stepper().isFinished()) wantStill("before");
}

/// Nothing of what was to be done is in the record.
void LiveProcedure::noteFailure(const hal::Error& error, Unwritten what) {
  const bool isAnswer = what != Unwritten::kOther;
  if (isAnswer && error.kind == hal::ErrorKind::kNoSpace) {
    fail(fmt::format("{} ({})", notices().diskFull, error.message()));
  } else if (what == Unwritten::kStillOfAnswer) {
    fail(procedure::filled(notices().pictureNotSaved, error.message()));
  } else {
    fail(procedure::filled(notices().notRecorded, error.message()));
  }
}

void LiveProcedure::goBack() {
  typed_.clear();
  mayJudge_ = false;
  stills_.clear();
  giveMove([this](StepSession& session) -> StepWorker::Then {
    const auto back = session.isSignedOff() ? Advanced(record::Advance::kRefused) : session.back();
    return [this, back] {
      moves_ = false;
      moved_ = clock_.now();
      if (!back) noteFailure(back.error(), Unwritten::kOther);
    };
  });
}

void LiveProcedure::changeOperator(const std::string& name) {
  if (!isRecorded()) return note(notices().noOperator);
  giveAside([this, name](StepSession& session) -> StepWorker::Then {
    if (session.isSignedOff()) return {};
    // Here, not before: another change may have been waiting to be written.
    if (session.view().operatorName == name) {
      return [this, name] { note(procedure::filled(notices().worksAlready, name)); };
    }
    const auto changed = session.changeOperator(name);
    return [this, name, changed] {
      if (!changed) return noteFailure(changed.error(), Unwritten::kOther);
      note(procedure::filled(notices().nowWorks, name));
    };
  });
}

void LiveProcedure::signOff() {
  if (!isRecorded()) return;
  giveMove([this](StepSession& session) -> StepWorker::Then {
    const auto signedOff = session.isSignedOff() ? hal::Result<void>() : session.signOff();
    return [this, signedOff] {
      moves_ = false;
      if (!signedOff) return noteFailure(signedOff.error(), Unwritten::kOther);
      stills_.clear();
      const bool isWhole = stepper().isFinished();
      note(procedure::filled(isWhole ? notices().signedOff : notices().aborted, view().finalHash));
    };
  });
}

/// Saves a still, and ends the step that waited for it. One that cannot be saved keeps the step.
void LiveProcedure::saveStill(const PendingStill& pending, hal::Image still) {
  const auto& answer = pending.answer;
  const auto outcome = answer ? procedure::outcomeOf(stepper().step(), *answer)
                              : std::optional<procedure::Outcome>();
  StepWorker::Job job = [this, pending, outcome, pose = poseNow(),
                         image = std::make_shared<const hal::Image>(std::move(still))](
                            StepSession& session) -> StepWorker::Then {
    const bool isAt =
        outcome ? session.isAt(pending.step, *pending.version) : session.isAt(pending.step);
    const auto saved = isAt ? session.addStill(pending.when, image->view()) : hal::Result<void>();
    auto advance = Advanced(record::Advance::kRefused);
    if (isAt && saved && outcome) advance = session.answer(*pending.answer, pose, {});
    return [this, saved, advance, outcome] {
      if (!saved) {
        moves_ = moves_ && !outcome;
        return noteFailure(saved.error(), outcome ? Unwritten::kStillOfAnswer : Unwritten::kOther);
      }
      if (outcome) endMove(advance, *outcome);
    };
  };
  if (!outcome) return giveAside(std::move(job));
  typed_.clear();
  giveMove(std::move(job));
}

/// Saves a still, compares it with the step's template, and ends the step with what that says.
void LiveProcedure::compare(const PendingStill& pending, hal::Image still,
                            const inspection::TemplatePose& place) {
  mayJudge_ = false;
  giveMove([this, pending, place, folder = options_.folder, pose = poseNow(),
            image = std::make_shared<const hal::Image>(std::move(still))](
               StepSession& session) -> StepWorker::Then {
    const auto refused = [this](const hal::Error& error) {
      return [this, error] {
        moves_ = false;
        fail(error.message());
      };
    };
    if (!session.isAt(pending.step, *pending.version)) {
      return [this] { endMove(record::Advance::kRefused, procedure::Outcome::kUncertain); };
    }
    const procedure::Step step = session.stepper().step();
    if (const auto saved = session.addStill(pending.when, image->view()); !saved) {
      return [this, error = saved.error()] {
        moves_ = false;
        noteFailure(error, Unwritten::kStillOfAnswer);
      };
    }
    const auto result =
        compareStill(session.stepper().procedure(), step, folder, image->view(), place);
    if (!result) return refused(result.error());
    const procedure::Answer answer = answerOf(result->verdict);
    const auto advance = session.answer(answer, pose, "program");
    return [this, advance, inspection = *result, step = pending.step,
            outcome = *procedure::outcomeOf(step, answer)] {
      endMove(advance, outcome, inspection.verdict == inspection::Verdict::kUncertain);
      if (advance) endComparison(inspection, step);
    };
  });
}

/// Where the program was uncertain, people may answer.
void LiveProcedure::endComparison(const inspection::Inspection& inspection,
                                  const std::string& step) {
  if (inspection.verdict != inspection::Verdict::kUncertain) return;
  mayJudge_ = !stepper().isFinished() && stepper().step().id == step;
  std::string text = procedure::filled(notices().uncertain, reasonText(inspection, notices()));
  if (mayJudge_) text += fmt::format("; {}", notices().mayJudge);
  note(text);
}

/// Takes the procedure as it is in its folder now; with a mistake, the last version stays.
void LiveProcedure::readAgain() {
  isReading_ = true;
  const auto failed = [this](const std::string& problem) {
    isReading_ = false;
    fail(problem);
  };
  StepWorker::Job job = [this, failed,
                         folder = options_.folder](StepSession& session) -> StepWorker::Then {
    const auto fails = [&](std::string problem) {
      return [failed, problem = std::move(problem)] { failed(problem); };
    };
    if (isEnding_) return {};  // nobody would see it
    procedure::ProcedureReading reading = procedure::readProcedureFolder(folder);
    if (!reading.faults.empty()) return fails(reading.faults.front().what());
    const bool isSame = reading.procedure.hash == session.stepper().procedure().hash;
    if (isSame || session.isSignedOff()) return [this] { isReading_ = false; };
    const auto changed = session.changeProcedure(
        std::make_shared<const procedure::Procedure>(std::move(reading.procedure)));
    if (!changed) return fails(changed.error().message());
    return [this] {
      isReading_ = false;
      note(notices().readAgain);
    };
  };
  worker_->give(std::move(job), failed);
}

}  // namespace pleinair::app
