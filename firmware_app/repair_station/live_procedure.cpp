#include "firmware_app/repair_station/live_procedure.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <ctime>
#include <ranges>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/config_error.h"
#include "firmware_app/overlay/machine.h"
#include "hal/media/picture_file.h"
#include "pipeline/inspection/part_inspection.h"
#include "pipeline/procedure/procedure_file.h"
#include "pipeline/procedure/words.h"
#include "pipeline/record/record_check.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;

using procedure::CheckKind;
using procedure::Procedure;
using procedure::StepCommandKind;

constexpr hal::Duration kProcedurePollInterval = std::chrono::milliseconds(500);
constexpr const char* kUnnamed = "unnamed";
constexpr const char* kFromKeys = "the keys";

/// The newest record of the procedure that is not signed off.
std::optional<fs::path> openRecord(const fs::path& folder, const std::string& procedure) {
  std::vector<fs::path> records;
  std::error_code failure;
  for (fs::directory_iterator at(folder, failure), end; !failure && at != end;
       at.increment(failure)) {
    if (at->path().extension() == ".jsonl") records.push_back(at->path());
  }
  std::ranges::sort(records, std::ranges::greater());
  for (const fs::path& each : records) {
    const auto reading = record::checkRecordFile(each);
    if (!reading || reading->entries.empty()) continue;
    const auto* begun = std::get_if<record::Begun>(&reading->entries.front().event);
    if (begun == nullptr || begun->procedure != procedure) continue;
    if (!reading->isSignedOff()) return each;
    return std::nullopt;
  }
  return std::nullopt;
}

/// A name of a file: what is not a letter, digit, '-' or '_' becomes '_'.
std::string fileNameOf(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool isKept = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                        (c >= '0' && c <= '9') || c == '-' || c == '_';
    name += isKept ? c : '_';
  }
  return name;
}

fs::path newRecord(const fs::path& folder, const std::string& procedure) {
  const std::time_t now = std::time(nullptr);
  const std::string stem =
      fmt::format("{}-{:%Y%m%d-%H%M%S}", fileNameOf(procedure), fmt::gmtime(now));
  fs::path path = folder / (stem + ".jsonl");
  for (int number = 2; fs::exists(path); ++number) {
    path = folder / fmt::format("{}-{}.jsonl", stem, number);
  }
  return path;
}

constexpr double kPartMargin = 1.15;  // of what is compared, about the step's parts

/// What a step asks for, and the keys.
std::string requestOf(const procedure::Step& step, const procedure::StepText& text,
                      const std::string& typed, const procedure::Words& words) {
  if (!step.check) return std::string(words.pressDone);
  switch (step.check->kind) {
    case CheckKind::kYesNo:
      return text.question + "  (y, n)";
    case CheckKind::kValue:
      return fmt::format("{}: {}_ ({}), {}", text.question, typed,
                         procedure::limitsText(*step.check), words.pressValue);
    case CheckKind::kPhoto:
      return std::string(words.pressPhoto);
    case CheckKind::kCompare:
      return fmt::format("{}: {}", words.comparison, words.pressCompare);
  }
  return {};
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
  begin(std::move(procedure));
  wantStillBefore();
  publish();
}

void LiveProcedure::begin(std::shared_ptr<const Procedure> procedure) {
  if (options_.records.empty()) {
    unrecorded_.emplace(std::move(procedure));
    return;
  }
  if (const auto open = openRecord(options_.records, procedure->name)) {
    session_.emplace(hal::orThrow(record::WorkSession::resume(procedure, *open, options_.program)));
    if (!options_.operatorName.empty() && options_.operatorName != session_->operatorName()) {
      hal::orThrow(session_->changeOperator(options_.operatorName));
    }
    note("resumed: " + open->string());
    return;
  }
  const fs::path path = newRecord(options_.records, procedure->name);
  const std::string operatorName =
      options_.operatorName.empty() ? std::string(kUnnamed) : options_.operatorName;
  session_.emplace(hal::orThrow(record::WorkSession::begin(std::move(procedure), path,
                                                           {.program = options_.program,
                                                            .operatorName = operatorName,
                                                            .workOrder = options_.workOrder,
                                                            .language = options_.language})));
}

const procedure::Stepper& LiveProcedure::stepper() const {
  return session_ ? session_->stepper() : *unrecorded_;
}

bool LiveProcedure::press(const hal::KeyPressed& key) {
  if (isSignedOff()) return false;
  source_ = kFromKeys;
  if (key.name == "pageup" || key.name == "pagedown" || key.name == "return") {
    if (key.isRepeat) return true;  // a pedal that is held does not run through the steps
    if (isTooSoon(kFromKeys)) return true;
  }
  if (key.name == "pageup") {
    goBack();
  } else if (key.name == "x" && key.shift) {
    signOff();
  } else if (stepper().isFinished()) {
    if (key.name != "return") return false;
    signOff();
  } else if (!pressForStep(key)) {
    return false;
  }
  publish();
  return true;
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
  if (isTooSoon(kFromKeys)) return true;
  return say(key.name == "y"   ? StepCommandKind::kYes
             : key.name == "n" ? StepCommandKind::kNo
                               : StepCommandKind::kUncertain);
}

/// Whether another input has just been obeyed, or this one bounces.
bool LiveProcedure::isTooSoon(const std::string& source) {
  if (!moved_) return false;
  const hal::Duration since = clock_.now() - *moved_;
  if (source == moveSource_) return source != kFromKeys && since < kBounce;
  if (since >= kOneAtATime) return false;
  note(fmt::format("two inputs at once: {} counted, {} did not", moveSource_, source));
  return true;
}

bool LiveProcedure::obey(const procedure::StepCommand& command, const std::string& source) {
  source_ = source;
  if (isSignedOff()) {
    note("the record is signed off: the next one begins with the program");
    return false;
  }
  if (isTooSoon(source)) return false;
  bool isObeyed = true;
  switch (command.kind) {
    case StepCommandKind::kBack:
      goBack();
      break;
    case StepCommandKind::kOperator:
      changeOperator(command.operatorName);
      break;
    case StepCommandKind::kAbort:
      signOff();
      break;
    default:
      isObeyed = obeyForStep(command);
  }
  publish();
  return isObeyed;
}

bool LiveProcedure::obeyForStep(const procedure::StepCommand& command) {
  const bool signsOff = command.kind == StepCommandKind::kSignOff;
  if (stepper().isFinished()) {
    if (signsOff) {
      signOff();
    } else {
      note("this is the end: sign_off, or back");
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
  note(signsOff ? "there are steps left: abort signs off before the end"
                : fmt::format("{}: this step asks for something else", textOf(command)));
  return false;
}

/// Ends the step where that needs no answer; a question is not answered by going on.
void LiveProcedure::goOn() {
  const auto kind = stepper().step().checkKind();
  if (!kind) {
    answer(procedure::Done{});
  } else if (*kind == CheckKind::kPhoto) {
    if (!stills_.hasAnswer()) wantStill("check", procedure::PhotoTaken{});
  } else if (*kind == CheckKind::kValue) {
    giveValue();
  } else if (*kind == CheckKind::kCompare && comparesByItself()) {
    if (stills_.hasAnswer()) return;
    stills_.add({.step = stepper().step().id,
                 .when = "check",
                 .answer = {},
                 .compares = true,
                 .requested = clock_.now()});
  } else {
    note("this step asks a question: y or n");
  }
}

/// Answers a question or a comparison; false where the step asks for another answer.
bool LiveProcedure::say(StepCommandKind word) {
  using procedure::Comparison;
  const auto kind = stepper().step().checkKind();
  if (kind == CheckKind::kYesNo && word != StepCommandKind::kUncertain) {
    answer(procedure::YesNo{word == StepCommandKind::kYes});
    return true;
  }
  if (kind != CheckKind::kCompare) return false;
  if (stills_.hasAnswer()) {
    note("one moment: the camera's picture is awaited");
    return true;
  }
  if (comparesByItself() && !mayJudge_) {
    note("the picture decides: next, or photo");
    return true;
  }
  commit(word == StepCommandKind::kYes  ? Comparison::kPass
         : word == StepCommandKind::kNo ? Comparison::kFail
                                        : Comparison::kUncertain,
         "operator");
  return true;
}

/// Whether the template of the step says where it was taken.
bool LiveProcedure::comparesByItself() const {
  const fs::path picture = options_.folder / stepper().step().check->comparison;
  std::error_code failure;
  return fs::is_regular_file(inspection::templatePosePath(picture), failure);
}

/// Compares a still with the step's template, and ends the step with what that says.
void LiveProcedure::compare(const hal::Image& still,
                            const std::optional<inspection::TemplatePose>& place) {
  using procedure::Comparison;
  const auto& check = stepper().step().check;
  // The procedure may have been edited since the picture was asked for.
  if (!check || check->kind != CheckKind::kCompare) return;
  if (!place) return note("the machine is not located: show its tags to the camera, then again");
  const fs::path file = options_.folder / check->comparison;
  const auto picture = hal::readPictureRgb(file);
  if (!picture) return note(picture.error().message());
  std::optional<inspection::TemplatePose> pose;
  try {
    pose = inspection::readTemplatePose(inspection::templatePosePath(file));
  } catch (const config::ConfigError& error) {
    return note(error.what());
  }
  if (pose->camera.imageSize() != picture->size()) {
    return note(file.string() + ": its pose is for another size: take the template anew");
  }
  const PartSurface part = surfaceOfParts(*stepper().procedure().model, stepper().step().parts);
  const inspection::Inspection result =
      inspection::inspectPart({picture->view(), pose->camera, pose->cameraFromModel},
                              {still.view(), place->camera, place->cameraFromModel},
                              {.centre = glm::dvec3(part.sphere.centre),
                               .radiusMetres = kPartMargin * part.sphere.radiusMetres,
                               .triangles = part.triangles});
  const std::string before = stepper().step().id;
  commit(result.verdict == inspection::Verdict::kPass   ? Comparison::kPass
         : result.verdict == inspection::Verdict::kFail ? Comparison::kFail
                                                        : Comparison::kUncertain,
         "program");
  if (result.verdict != inspection::Verdict::kUncertain) return;
  mayJudge_ = !stepper().isFinished() && stepper().step().id == before;
  note("uncertain: " + result.reason + (mayJudge_ ? "; again, or yes or no" : ""));
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
    note(fmt::format("type a value in {}, then Enter", stepper().step().check->unit));
    return;
  }
  answer(procedure::MeasuredValue{value});
}

/// Ends the step with this answer, after its still where each step has one.
void LiveProcedure::answer(const procedure::Answer& answer) {
  if (stills_.hasAnswer()) {
    note("one moment: the camera's picture is awaited");
  } else if (session_ && options_.stillsOfSteps) {
    wantStill("after", answer);
  } else {
    commit(answer);
  }
}

void LiveProcedure::wantStill(std::string when, std::optional<procedure::Answer> answer) {
  stills_.add({.step = stepper().step().id,
               .when = std::move(when),
               .answer = std::move(answer),
               .requested = clock_.now()});
}

/// Wants the still before a step, unless a resumed record has it already.
void LiveProcedure::wantStillBefore() {
  if (!session_ || !options_.stillsOfSteps || isSignedOff() || stepper().isFinished()) return;
  for (const record::RecordEntry& entry : session_->record().entries() | std::views::reverse) {
    if (std::holds_alternative<record::StepDone>(entry.event)) break;
    const auto* still = std::get_if<record::StillTaken>(&entry.event);
    if (still != nullptr && still->when == "before" && still->step == stepper().step().id) return;
  }
  wantStill("before");
}

void LiveProcedure::commit(const procedure::Answer& answer, const std::string& by) {
  typed_.clear();
  mayJudge_ = false;
  const procedure::Step& step = stepper().step();
  const auto outcome = procedure::outcomeOf(step, answer);
  if (!outcome) return;
  bool hasMoved = false;
  if (session_) {
    const auto advanced = session_->answer(answer, poseNow(), by);
    if (!advanced) {
      note(advanced.error().message());
      return;
    }
    hasMoved = *advanced == record::Advance::kMoved;
  } else {
    hasMoved = unrecorded_->advance(*outcome);
  }
  moved_ = clock_.now();
  moveSource_ = source_;
  const procedure::Words& words = procedure::wordsIn(options_.language);
  if (hasMoved) wantStillBefore();
  if (!hasMoved) note(fmt::format("{}: do this step again", procedure::wordOf(words, *outcome)));
}

void LiveProcedure::locate(const std::optional<record::PoseQuality>& pose) {
  pose_ = pose;
  located_ = clock_.now();
}

std::optional<record::PoseQuality> LiveProcedure::poseNow() const {
  if (!pose_ || clock_.now() - located_ <= kPoseLasts) return pose_;
  return record::PoseQuality{.source = "none"};
}

void LiveProcedure::goBack() {
  typed_.clear();
  mayJudge_ = false;
  stills_.clear();
  moved_ = clock_.now();
  moveSource_ = source_;
  if (!session_) {
    unrecorded_->back();
  } else if (const auto back = session_->back(); !back) {
    note(back.error().message());
  }
}

void LiveProcedure::changeOperator(const std::string& name) {
  if (!session_) {
    note("nothing is recorded: there is no operator");
  } else if (session_->operatorName() == name) {
    note(name + " works already");
  } else if (const auto changed = session_->changeOperator(name); !changed) {
    note(changed.error().message());
  } else {
    note("now works: " + name);
  }
}

void LiveProcedure::signOff() {
  if (!session_) return;
  if (const auto signedOff = session_->signOff(); !signedOff) {
    note(signedOff.error().message());
    return;
  }
  stills_.clear();
  note("signed off; final hash " + session_->record().finalHash());
}

bool LiveProcedure::takeStillRequest() {
  return stills_.takeRequest();
}

void LiveProcedure::putStill(const hal::Result<hal::Image>& still,
                             const std::optional<inspection::TemplatePose>& place) {
  const std::optional<PendingStill> pending = stills_.take();
  if (!pending || isSignedOff() || stepper().isFinished()) return;
  if (!still) return note(still.error().message());
  // One that was asked for before the step was left shows another step's work.
  if (pending->step != stepper().step().id) return;
  if (session_) {
    const auto png = hal::encodePng(still->view());
    const auto added = png ? session_->addStill(pending->when, *png)
                           : hal::Result<void>(tl::unexpected(png.error()));
    if (!added) return note(added.error().message());
  }
  if (pending->answer) commit(*pending->answer);
  if (pending->compares) compare(*still, place);
  publish();
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
  const hal::TimePoint now = clock_.now();
  if (stills_.dropOverdue(now)) note("the camera gives no picture: the step is not done");
  if (now - polled_ < kProcedurePollInterval || isSignedOff()) return;
  polled_ = now;
  const fs::file_time_type newest = newestFile();
  if (newest == read_) return;
  read_ = newest;
  procedure::ProcedureReading reading = procedure::readProcedureFolder(options_.folder);
  if (!reading.faults.empty()) {
    note(reading.faults.front().what());
    return;
  }
  if (reading.procedure.hash == stepper().procedure().hash) return;
  auto next = std::make_shared<const Procedure>(std::move(reading.procedure));
  if (session_) {
    const auto changed = session_->changeProcedure(std::move(next));
    note(changed ? "the procedure was read again" : changed.error().message());
  } else {
    auto moved = unrecorded_->movedTo(std::move(next));
    note(moved ? "the procedure was read again" : moved.error().message());
    if (moved) *unrecorded_ = std::move(*moved);
  }
  publish();
}

std::string LiveProcedure::text() const {
  const Procedure& procedure = stepper().procedure();
  if (isSignedOff()) return {};
  const procedure::Words& words = procedure::wordsIn(options_.language);
  if (stepper().isFinished()) return fmt::format("{}. {}", words.theEnd, requestAtEnd());
  const std::size_t index = stepper().current();
  const procedure::Step& step = stepper().step();
  const procedure::StepText& text = procedure.text(index, options_.language);
  std::string lines = fmt::format("{}/{}  {}", index + 1, procedure.steps.size(), text.title);
  for (const std::size_t each : step.warnings) {
    const procedure::Warning& warning = procedure.warnings[each];
    lines += fmt::format("\n{}: {}", procedure::wordOf(words, warning.level),
                         translated(procedure, warning.text, options_.language));
  }
  if (!text.body.empty()) lines += "\n" + procedure::plainText(text.body);
  if (step.torque) lines += fmt::format("\n{}: {}", words.torque, step.torque->text);
  return lines + "\n" + requestOf(step, text, typed_, words);
}

std::string LiveProcedure::requestAtEnd() const {
  const procedure::Words& words = procedure::wordsIn(options_.language);
  return session_ ? fmt::format("{}, {}", words.pressSignOff, words.pressBack)
                  : std::string(words.pressBack);
}

StepShown LiveProcedure::shown() const {
  StepShown shown{.procedure = stepper().procedurePointer(),
                  .step = stepper().current(),
                  .partsOff = stepper().partsOff(),
                  .language = options_.language};
  if (isSignedOff()) {
    shown.step = procedure::kEnd;  // it may be aborted: nothing points at the machine any more
    return shown;
  }
  if (stepper().isFinished()) {
    shown.request = requestAtEnd();
    return shown;
  }
  const procedure::StepText& text = shown.procedure->text(shown.step, options_.language);
  shown.request = requestOf(stepper().step(), text, typed_, procedure::wordsIn(options_.language));
  return shown;
}

std::optional<std::string> LiveProcedure::takeNotice() {
  return std::exchange(notice_, std::nullopt);
}

void LiveProcedure::publish() {
  const Procedure& procedure = stepper().procedure();
  runtime::ProcedureStatus status{
      .name = procedure.name,
      .version = procedure.version,
      .step = procedure::stepName(procedure, stepper().current()),
      .number = stepper().isFinished() ? 0 : stepper().current() + 1,
      .steps = procedure.steps.size(),
      .record = session_ ? session_->record().path().string() : std::string(),
      .isSignedOff = isSignedOff()};
  const std::scoped_lock lock(mutex_);
  status_ = std::move(status);
}

runtime::ProcedureStatus LiveProcedure::status() const {
  const std::scoped_lock lock(mutex_);
  return status_;
}

}  // namespace pleinair::app
