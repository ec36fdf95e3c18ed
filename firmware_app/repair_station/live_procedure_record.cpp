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
}

void LiveProcedure::commit(const procedure::Answer& answer, const std::string& by) {
  typed_.clear();
  mayJudge_ = false;
  const auto outcome = procedure::outcomeOf(stepper().step(), answer);
  if (!outcome) return;
  beginMove();
  worker_->give([this, answer, by, outcome = *outcome, pose = poseNow(), step = stepper().step().id,
                 version = stepper().procedurePointer()](StepSession& session) -> StepWorker::Then {
    const auto advance = session.isAt(step, *version) ? session.answer(answer, pose, by)
                                                      : Advanced(record::Advance::kRefused);
    return [this, advance, outcome] { endMove(advance, outcome); };
  });
}

/// An answer is on the disk, or has failed.
void LiveProcedure::endMove(const hal::Result<record::Advance>& advance,
                            procedure::Outcome outcome) {
  moves_ = false;
  if (!advance) return noteFailure(advance.error(), false);
  // The thread had read another version before: nobody has seen its text and limits.
  if (*advance == record::Advance::kRefused) return note(notices().wasEdited);
  moved_ = clock_.now();
  typed_.clear();
  if (*advance == record::Advance::kStayed) {
    note(procedure::filled(notices().doAgain,
                           procedure::wordOf(procedure::wordsIn(options_.language), outcome)));
    return;
  }
  if (isRecorded() && options_.stillsOfSteps && !stepper().isFinished()) wantStill("before");
}

/// Nothing of what was to be done is in the record.
void LiveProcedure::noteFailure(const hal::Error& error, bool isStill) {
  if (error.kind == hal::ErrorKind::kNoSpace) {
    note(fmt::format("{} ({})", notices().diskFull, error.message()));
  } else if (isStill) {
    note(procedure::filled(notices().pictureNotSaved, error.message()));
  } else {
    note(error.message());
  }
}

void LiveProcedure::goBack() {
  typed_.clear();
  mayJudge_ = false;
  stills_.clear();
  beginMove();
  worker_->give([this](StepSession& session) -> StepWorker::Then {
    const auto back = session.isSignedOff() ? Advanced(record::Advance::kRefused) : session.back();
    return [this, back] {
      moves_ = false;
      moved_ = clock_.now();
      if (!back) noteFailure(back.error(), false);
    };
  });
}

void LiveProcedure::changeOperator(const std::string& name) {
  if (!isRecorded()) return note(notices().noOperator);
  if (view().operatorName == name) return note(procedure::filled(notices().worksAlready, name));
  worker_->give([this, name](StepSession& session) -> StepWorker::Then {
    const auto changed = session.isSignedOff() ? hal::Result<void>() : session.changeOperator(name);
    return [this, name, changed] {
      if (!changed) return noteFailure(changed.error(), false);
      note(procedure::filled(notices().nowWorks, name));
    };
  });
}

void LiveProcedure::signOff() {
  if (!isRecorded()) return;
  beginMove();
  worker_->give([this](StepSession& session) -> StepWorker::Then {
    const auto signedOff = session.isSignedOff() ? hal::Result<void>() : session.signOff();
    return [this, signedOff] {
      moves_ = false;
      if (!signedOff) return noteFailure(signedOff.error(), false);
      stills_.clear();
      note(procedure::filled(notices().signedOff, view().finalHash));
    };
  });
}

/// Saves a still, and ends the step that waited for it. One that cannot be saved keeps the step.
void LiveProcedure::saveStill(const PendingStill& pending, hal::Image still) {
  const auto& answer = pending.answer;
  const auto outcome = answer ? procedure::outcomeOf(stepper().step(), *answer)
                              : std::optional<procedure::Outcome>();
  if (outcome) {
    typed_.clear();
    beginMove();
  }
  worker_->give([this, pending, outcome, pose = poseNow(),
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
        return noteFailure(saved.error(), true);
      }
      if (outcome) endMove(advance, *outcome);
    };
  });
}

/// Saves a still, compares it with the step's template, and ends the step with what that says.
void LiveProcedure::compare(const PendingStill& pending, hal::Image still,
                            const inspection::TemplatePose& place) {
  mayJudge_ = false;
  beginMove();
  worker_->give([this, pending, place, folder = options_.folder, pose = poseNow(),
                 image = std::make_shared<const hal::Image>(std::move(still))](
                    StepSession& session) -> StepWorker::Then {
    const auto failed = [&](const hal::Error& error, bool isStill) {
      return [this, error, isStill] {
        moves_ = false;
        noteFailure(error, isStill);
      };
    };
    if (!session.isAt(pending.step, *pending.version)) {
      return [this] { endMove(record::Advance::kRefused, procedure::Outcome::kUncertain); };
    }
    const procedure::Step step = session.stepper().step();
    if (const auto saved = session.addStill(pending.when, image->view()); !saved) {
      return failed(saved.error(), true);
    }
    const auto result =
        compareStill(session.stepper().procedure(), step, folder, image->view(), place);
    if (!result) return failed(result.error(), false);
    const procedure::Answer answer = answerOf(result->verdict);
    const auto advance = session.answer(answer, pose, "program");
    return [this, advance, inspection = *result, step = pending.step,
            outcome = *procedure::outcomeOf(step, answer)] {
      endMove(advance, outcome);
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
  worker_->give([this, folder = options_.folder](StepSession& session) -> StepWorker::Then {
    const auto after = [this](std::string notice) {
      return [this, notice = std::move(notice)] {
        isReading_ = false;
        if (!notice.empty()) note(notice);
      };
    };
    procedure::ProcedureReading reading = procedure::readProcedureFolder(folder);
    if (!reading.faults.empty()) return after(reading.faults.front().what());
    const bool isSame = reading.procedure.hash == session.stepper().procedure().hash;
    if (isSame || session.isSignedOff()) return after({});
    const auto changed = session.changeProcedure(
        std::make_shared<const procedure::Procedure>(std::move(reading.procedure)));
    return after(changed ? std::string(notices().readAgain) : changed.error().message());
  });
}

}  // namespace pleinair::app
