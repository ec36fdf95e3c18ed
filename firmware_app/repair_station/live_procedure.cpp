#include "firmware_app/repair_station/live_procedure.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <memory>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/config_error.h"
#include "firmware_app/repair_station/step_text.h"
#include "firmware_app/repair_station/still_comparison.h"
#include "pipeline/procedure/procedure_file.h"
#include "pipeline/procedure/words.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;

using procedure::CheckKind;
using procedure::Procedure;
using procedure::StepCommandKind;

constexpr hal::Duration kProcedurePollInterval = std::chrono::milliseconds(500);

/// Keys that answer a step or leave it; digits only add to a value.
bool movesStep(const hal::KeyPressed& key) {
  return key.name == "pageup" || key.name == "pagedown" || key.name == "return" ||
         key.name == "y" || key.name == "n" || key.name == "u" || (key.name == "x" && key.shift);
}

std::optional<std::string> takeFrom(std::deque<std::string>& texts) {
  if (texts.empty()) return std::nullopt;
  std::string text = std::move(texts.front());
  texts.pop_front();
  return text;
}

}  // namespace

LiveProcedure::LiveProcedure(LiveProcedureOptions options, const hal::Clock& clock)
    : options_(std::move(options)), clock_(clock) {
  read_ = newestFile();
  auto procedure = std::make_shared<const Procedure>(procedure::loadProcedure(options_.folder));
  const auto& languages = procedure->languages;
  if (options_.language.empty()) options_.language = languages.front();
  if (std::ranges::find(languages, options_.language) == languages.end()) {
    throw hal::Failure({.kind = hal::ErrorKind::kInvalidArgument,
                        .subject = "procedure.language",
                        .problem = fmt::format("found \"{}\"", options_.language),
                        .remedy = fmt::format("one of {}", fmt::join(languages, ", "))});
  }
  StepSession session =
      hal::orThrow(StepSession::open(std::move(procedure), {.records = options_.records,
                                                            .operatorName = options_.operatorName,
                                                            .workOrder = options_.workOrder,
                                                            .program = options_.program,
                                                            .language = options_.language,
                                                            .system = options_.system}));
  if (!session.resumed().empty()) note(procedure::filled(notices().resumed, session.resumed()));
  const bool hasStillBefore = session.hasStillBefore();
  worker_.emplace(std::move(session));
  if (isRecorded() && options_.stillsOfSteps && !hasStillBefore && !stepper().isFinished()) {
    wantStill("before");
  }
  publish();
}

bool LiveProcedure::press(const hal::KeyPressed& key) {
  if (isSignedOff()) return false;
  source_ = notices().theKeys;
  if (key.name == "pageup" || key.name == "pagedown" || key.name == "return") {
    if (key.isRepeat) return true;  // a pedal that is held does not run through the steps
    if (isTooSoon(source_)) return true;
  }
  if (movesStep(key) && moves_) return isMoving();
  if (key.name == "pageup") {
    goBack();
  } else if (key.name == "x" && key.shift) {
    if (!key.isRepeat) pressAbort();
  } else if (stepper().isFinished()) {
    if (key.name != "return") return false;
    signOff();
  } else {
    return pressForStep(key);
  }
  return true;
}

/// A record that is signed off cannot be gone on with, so one slip of a finger must not do it.
void LiveProcedure::pressAbort() {
  const hal::TimePoint now = clock_.now();
  const bool wasAsked = asked_ && now - *asked_ <= kAbortAgain;
  if (stepper().isFinished() || !isRecorded() || wasAsked) return signOff();
  asked_ = now;
  note(notices().abortAgain);
}

bool LiveProcedure::pressForStep(const hal::KeyPressed& key) {
  const procedure::Step& step = stepper().step();
  if (step.check && step.check->kind == CheckKind::kValue) return pressForValue(key);
  if (key.name == "pagedown") {
    goOn();
    return true;
  }
  const bool isQuestion = step.check && (step.check->kind == CheckKind::kYesNo ||
                                         step.check->kind == CheckKind::kCompare);
  if (!isQuestion) return false;
  if (key.name != "y" && key.name != "n" && key.name != "u") return false;
  if (isTooSoon(source_)) return true;
  return say(key.name == "y"   ? StepCommandKind::kYes
             : key.name == "n" ? StepCommandKind::kNo
                               : StepCommandKind::kUncertain);
}

/// Whether another input has just been obeyed, or this one bounces.
bool LiveProcedure::isTooSoon(const std::string& source) {
  if (!moved_) return false;
  const hal::Duration since = clock_.now() - *moved_;
  if (source == moveSource_) {
    // Keyboards bounce for themselves; a program that has seen the next step may be quick.
    const bool bounces = source != notices().theKeys && source != notices().theServer;
    return bounces && since < kBounce;
  }
  if (since >= kOneAtATime) return false;
  note(procedure::filled(notices().twoInputs, moveSource_, source));
  return true;
}

/// Whether an answer is being written; says so.
bool LiveProcedure::isMoving() {
  if (moves_) note(notices().isWriting);
  return moves_;
}

bool LiveProcedure::obey(const procedure::StepCommand& command, const std::string& source) {
  source_ = source;
  if (isSignedOff()) {
    note(notices().isSignedOff);
    return false;
  }
  if (isTooSoon(source) || isMoving()) return false;
  switch (command.kind) {
    case StepCommandKind::kBack:
      goBack();
      return true;
    case StepCommandKind::kOperator:
      changeOperator(command.operatorName);
      return true;
    case StepCommandKind::kAbort:
      signOff();
      return true;
    default:
      return obeyForStep(command);
  }
}

bool LiveProcedure::obeyForStep(const procedure::StepCommand& command) {
  const bool signsOff = command.kind == StepCommandKind::kSignOff;
  if (stepper().isFinished()) {
    if (signsOff) {
      signOff();
    } else {
      note(notices().atTheEnd);
    }
    return signsOff;
  }
  switch (command.kind) {
    case StepCommandKind::kNext:
      goOn();
      return true;
    case StepCommandKind::kPhoto: {
      const auto kind = stepper().step().checkKind();
      if (kind == CheckKind::kPhoto || kind == CheckKind::kCompare) {
        goOn();
      } else {
        wantStill("extra");
      }
      return true;
    }
    case StepCommandKind::kValue:
      if (stepper().step().checkKind() != CheckKind::kValue) break;
      answer(procedure::MeasuredValue{command.value});
      return true;
    case StepCommandKind::kYes:
    case StepCommandKind::kNo:
    case StepCommandKind::kUncertain:
      if (say(command.kind)) return true;
      break;
    default:
      break;
  }
  note(signsOff ? std::string(notices().stepsLeft)
                : procedure::filled(notices().otherAnswer, textOf(command)));
  return false;
}

/// Ends the step where that needs no answer; a question is not answered by going on.
void LiveProcedure::goOn() {
  const procedure::Step& step = stepper().step();
  const auto kind = step.checkKind();
  if (!kind) {
    answer(procedure::Done{});
  } else if (*kind == CheckKind::kPhoto) {
    if (!stills_.hasAnswer()) wantStill("check", procedure::PhotoTaken{});
  } else if (*kind == CheckKind::kValue) {
    giveValue();
  } else if (*kind == CheckKind::kCompare && comparesByItself(options_.folder, *step.check)) {
    if (stills_.hasAnswer()) return;
    stills_.add({.step = step.id,
                 .version = stepper().procedurePointer(),
                 .when = "check",
                 .answer = {},
                 .compares = true,
                 .requested = clock_.now()});
  } else {
    note(notices().asksQuestion);
  }
}

/// Answers a question or a comparison; false where the step asks for another answer.
bool LiveProcedure::say(StepCommandKind word) {
  using procedure::Comparison;
  const procedure::Step& step = stepper().step();
  const auto kind = step.checkKind();
  if (kind == CheckKind::kYesNo && word != StepCommandKind::kUncertain) {
    answer(procedure::YesNo{word == StepCommandKind::kYes});
    return true;
  }
  if (kind != CheckKind::kCompare) return false;
  if (stills_.hasAnswer()) {
    note(notices().awaitsPicture);
    return true;
  }
  if (comparesByItself(options_.folder, *step.check) && !mayJudge_) {
    note(notices().pictureDecides);
    return true;
  }
  commit(word == StepCommandKind::kYes  ? Comparison::kPass
         : word == StepCommandKind::kNo ? Comparison::kFail
                                        : Comparison::kUncertain,
         "operator");
  return true;
}

bool LiveProcedure::pressForValue(const hal::KeyPressed& key) {
  constexpr std::size_t kMaxDigits = 12;
  const std::string& name = key.name;
  const bool isDigit = name.size() == 1 && name[0] >= '0' && name[0] <= '9';
  if (isDigit || name == "." || name == "," || name == "-") {
    if (typed_.size() < kMaxDigits) typed_ += name == "," ? "." : name;
    return true;
  }
  if (name == "backspace" && !typed_.empty()) {
    typed_.pop_back();
    return true;
  }
  if (name != "return" && name != "pagedown") return false;
  giveValue();
  return true;
}

/// Gives the value that was typed.
void LiveProcedure::giveValue() {
  double value = 0.0;
  const char* const end = typed_.data() + typed_.size();
  const auto parsed = std::from_chars(typed_.data(), end, value);
  if (typed_.empty() || parsed.ec != std::errc{} || parsed.ptr != end) {
    note(procedure::filled(notices().typeValue, stepper().step().check->unit));
    return;
  }
  answer(procedure::MeasuredValue{value});
}

/// Ends the step with this answer, after its still where each step has one.
void LiveProcedure::answer(const procedure::Answer& answer) {
  if (stills_.hasAnswer()) {
    note(notices().awaitsPicture);
  } else if (isRecorded() && options_.stillsOfSteps) {
    wantStill("after", answer);
  } else {
    commit(answer);
  }
}

void LiveProcedure::wantStill(std::string when, std::optional<procedure::Answer> answer) {
  stills_.add({.step = stepper().step().id,
               .version = stepper().procedurePointer(),
               .when = std::move(when),
               .answer = std::move(answer),
               .requested = clock_.now()});
}

void LiveProcedure::locate(const std::optional<record::PoseQuality>& pose) {
  pose_ = pose;
  located_ = clock_.now();
}

std::optional<record::PoseQuality> LiveProcedure::poseNow() const {
  if (!pose_ || clock_.now() - located_ <= kPoseLasts) return pose_;
  return record::PoseQuality{.source = "none"};
}

bool LiveProcedure::takeStillRequest() {
  // While an answer is written, the next step's picture would be one of this step.
  return !moves_ && stills_.takeRequest();
}

void LiveProcedure::putStill(hal::Result<hal::Image> still,
                             const std::optional<inspection::TemplatePose>& place) {
  const std::optional<PendingStill> pending = stills_.take();
  if (!pending || isSignedOff() || stepper().isFinished()) return;
  if (!still) return fail(still.error().message());
  // One that was asked for before the step was left shows another step's work.
  if (pending->step != stepper().step().id) return;
  if (pending->endsStep() && pending->version != stepper().procedurePointer()) {
    return note(notices().wasEdited);
  }
  if (!pending->compares) return saveStill(*pending, *std::move(still));
  if (!place) return note(notices().notLocated);
  compare(*pending, *std::move(still), *place);
}

fs::file_time_type LiveProcedure::newestFile() const {
  fs::file_time_type newest = fs::file_time_type::min();
  std::error_code failure;
  for (fs::recursive_directory_iterator at(options_.folder, failure), end; !failure && at != end;
       at.increment(failure)) {
    std::error_code ignored;
    newest = std::max(newest, fs::last_write_time(at->path(), ignored));
  }
  return newest;
}

void LiveProcedure::poll() {
  if (worker_->poll()) publish();
  const hal::TimePoint now = clock_.now();
  if (stills_.dropOverdue(now)) fail(notices().noPicture);
  if (now - polled_ >= kProcedurePollInterval && !isSignedOff() && !isReading_) {
    polled_ = now;
    const fs::file_time_type newest = newestFile();
    if (std::exchange(read_, newest) != newest) readAgain();
  }
}

void LiveProcedure::finish() {
  worker_->finish();
  publish();
}

LiveProcedure::RecordEnd LiveProcedure::end(hal::Duration patience) {
  isEnding_ = true;
  const bool isDone = worker_->finish(patience);
  publish();
  if (isDone) return RecordEnd::kWritten;
  return isReading_ && worker_->open() == 1 ? RecordEnd::kIsReading : RecordEnd::kIsWriting;
}

std::string LiveProcedure::text() const {
  if (isSignedOff()) return {};
  const std::string& language = options_.language;
  if (stepper().isFinished()) {
    return fmt::format("{}. {}", procedure::wordsIn(language).theEnd,
                       requestAtEnd(language, isRecorded()));
  }
  return captionOf(procedure(), stepper().current(), language) + "\n" +
         requestOf(procedure(), stepper().current(), language, typed_);
}

StepShown LiveProcedure::shown() const {
  StepShown shown{.procedure = stepper().procedurePointer(),
                  .step = stepper().current(),
                  .partsOff = stepper().partsOff(),
                  .language = options_.language};
  if (isSignedOff()) {
    shown.isAborted = !stepper().isFinished();
    shown.step = procedure::kEnd;  // nothing points at the machine any more
  } else if (stepper().isFinished()) {
    shown.request = requestAtEnd(options_.language, isRecorded());
  } else {
    shown.request = requestOf(*shown.procedure, shown.step, options_.language, typed_);
  }
  return shown;
}

void LiveProcedure::put(std::deque<std::string>& texts, std::string_view text) {
  if (texts.empty() || texts.back() != text) texts.emplace_back(text);
}

std::optional<std::string> LiveProcedure::takeNotice() {
  return takeFrom(notices_);
}

std::optional<std::string> LiveProcedure::takeFailure() {
  return takeFrom(failures_);
}

void LiveProcedure::publish() {
  const Procedure& procedure = stepper().procedure();
  runtime::ProcedureStatus status{.name = procedure.name,
                                  .version = procedure.version,
                                  .step = procedure::stepName(procedure, stepper().current()),
                                  .number = stepper().isFinished() ? 0 : stepper().current() + 1,
                                  .steps = procedure.steps.size(),
                                  .record = view().record,
                                  .isSignedOff = isSignedOff()};
  const std::scoped_lock lock(mutex_);
  status_ = std::move(status);
}

runtime::ProcedureStatus LiveProcedure::status() const {
  const std::scoped_lock lock(mutex_);
  return status_;
}

}  // namespace pleinair::app
