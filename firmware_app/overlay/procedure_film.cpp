#include "firmware_app/overlay/procedure_film.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "config/config_error.h"
#include "config/suggestion.h"
#include "firmware_app/overlay/machine.h"
#include "hal/error.h"
#include "pipeline/procedure/procedure_file.h"
#include "pipeline/procedure/stepper.h"
#include "pipeline/procedure/words.h"

namespace pleinair::app {
namespace {

using procedure::Procedure;

/// What a step's check asks for, with its limits.
std::string questionOf(const Procedure& procedure, std::size_t index, const std::string& language) {
  const procedure::Step& step = procedure.steps[index];
  if (!step.check) return {};
  const procedure::Words& words = procedure::wordsIn(language);
  if (step.check->kind == procedure::CheckKind::kPhoto) return std::string(words.photo);
  if (step.check->kind == procedure::CheckKind::kCompare) return std::string(words.comparison);
  std::string text = procedure.text(index, language).question;
  if (step.check->kind == procedure::CheckKind::kValue) {
    text += ": " + procedure::withDecimals(procedure::limitsText(*step.check), language);
  }
  return text;
}

/// The index of a step by id or number.
std::size_t stepNamed(const Procedure& procedure, const std::string& name) {
  if (const auto found = procedure.findStep(name)) return *found;
  std::size_t number = 0;
  const char* const end = name.data() + name.size();
  const auto parsed = std::from_chars(name.data(), end, number);
  if (parsed.ec == std::errc{} && parsed.ptr == end && number >= 1 &&
      number <= procedure.steps.size()) {
    return number - 1;
  }
  std::vector<std::string> ids;
  for (const procedure::Step& each : procedure.steps) ids.push_back(each.id);
  throw hal::Failure(
      {.kind = hal::ErrorKind::kInvalidArgument,
       .subject = "--step",
       .problem = "there is no step " + config::quoted(name),
       .remedy = fmt::format("1 to {}, or one of: {}", ids.size(), config::listText(ids))});
}

}  // namespace

ProcedureFilm::ProcedureFilm(ProcedureFilmOptions options, scene::Scene& scene)
    : options_(std::move(options)),
      procedure_(std::make_shared<const Procedure>(procedure::loadProcedure(options_.folder))) {
  const auto& languages = procedure_->languages;
  if (options_.language.empty()) options_.language = languages.front();
  if (std::ranges::find(languages, options_.language) == languages.end()) {
    throw hal::Failure({.kind = hal::ErrorKind::kInvalidArgument,
                        .subject = "procedure.language",
                        .problem = "found " + config::quoted(options_.language),
                        .remedy = "one of " + config::listText(languages)});
  }
  machine_ = machineIn(scene, *procedure_, options_.machine);
  putMachine(scene, machine_, *procedure_);
  model_ = scene.models[machine_].model;
  findSteps();
}

void ProcedureFilm::findSteps() {
  const bool isOne = !options_.step.empty();
  const std::size_t only = isOne ? stepNamed(*procedure_, options_.step) : 0;
  procedure::Stepper stepper(procedure_);
  std::vector<bool> isPast(procedure_->steps.size());
  while (!stepper.isFinished() && !isPast[stepper.current()]) {
    isPast[stepper.current()] = true;
    StepShown shown{.procedure = procedure_,
                    .step = stepper.current(),
                    .partsOff = stepper.partsOff(),
                    .language = options_.language,
                    .request = questionOf(*procedure_, stepper.current(), options_.language)};
    if (!isOne || only == shown.step) steps_.push_back(std::move(shown));
    const auto outcomes = procedure::outcomesOf(stepper.step().checkKind());
    if (!stepper.advance(outcomes.front())) break;
  }
  if (!steps_.empty()) return;
  // Off the way of the good outcomes: all parts are there.
  steps_.push_back({.procedure = procedure_,
                    .step = only,
                    .partsOff = {},
                    .language = options_.language,
                    .request = questionOf(*procedure_, only, options_.language)});
}

std::shared_ptr<const overlay::OverlayContent> ProcedureFilm::at(hal::Duration time,
                                                                 hal::FrameSize output) {
  const auto number = static_cast<std::size_t>(
      std::max(0.0, hal::toSeconds(time) / std::max(options_.secondsPerStep, 1e-3)));
  const std::size_t index = std::min(number, steps_.size() - 1);
  if (shown_ != index) {
    auto content = stepContent(steps_[index], *model_, options_.folder, output,
                               stepInset(steps_[index], *model_, output.width));
    content.showsInset = options_.showsInset;
    content.movie = stepMovie(steps_[index], options_.folder, content.moviePlace);
    content_ = std::make_shared<const overlay::OverlayContent>(std::move(content));
    shown_ = index;
  }
  return content_;
}

}  // namespace pleinair::app
