#include "firmware_app/repair_station/step_text.h"

#include <fmt/format.h>

#include "pipeline/procedure/notices.h"
#include "pipeline/procedure/words.h"

namespace pleinair::app {

std::string requestOf(const procedure::Procedure& procedure, std::size_t index,
                      const std::string& language, const std::string& typed) {
  const procedure::Words& words = procedure::wordsIn(language);
  const procedure::Step& step = procedure.steps[index];
  if (!step.check) return std::string(words.pressDone);
  const std::string& question = procedure.text(index, language).question;
  switch (step.check->kind) {
    case procedure::CheckKind::kYesNo:
      return question + "  (y, n)";
    case procedure::CheckKind::kValue:
      return fmt::format("{}: {}_ ({}), {}", question, typed,
                         procedure::withDecimals(procedure::limitsText(*step.check), language),
                         words.pressValue);
    case procedure::CheckKind::kPhoto:
      return std::string(words.pressPhoto);
    case procedure::CheckKind::kCompare:
      return fmt::format("{}: {}", words.comparison, words.pressCompare);
  }
  return {};
}

std::string requestAtEnd(const std::string& language, bool isRecorded) {
  const procedure::Words& words = procedure::wordsIn(language);
  return isRecorded ? fmt::format("{}, {}", words.pressSignOff, words.pressBack)
                    : std::string(words.pressBack);
}

std::string captionOf(const procedure::Procedure& procedure, std::size_t index,
                      const std::string& language) {
  const procedure::Words& words = procedure::wordsIn(language);
  const procedure::Step& step = procedure.steps[index];
  const procedure::StepText& text = procedure.text(index, language);
  std::string lines = fmt::format("{}/{}  {}", index + 1, procedure.steps.size(), text.title);
  for (const std::size_t each : step.warnings) {
    const procedure::Warning& warning = procedure.warnings[each];
    lines += fmt::format("\n{}: {}", procedure::wordOf(words, warning.level),
                         translated(procedure, warning.text, language));
  }
  if (!text.body.empty()) lines += "\n" + procedure::plainText(text.body);
  if (step.torque)
    lines +=
        fmt::format("\n{}: {}", words.torque, procedure::withDecimals(step.torque->text, language));
  return lines;
}

std::string keyHelp(const std::string& language) {
  const procedure::Notices& notices = procedure::noticesIn(language);
  return fmt::format(
      "Page Down\t{}\nPage Up\t{}\ny, n, u\t{}\n{}, Enter\t{}\nEnter\t{}\nShift-X\t{}",
      notices.keyNext, notices.keyBack, notices.keyAnswer, notices.digits, notices.keyValue,
      notices.keySignOff, notices.keyAbort);
}

}  // namespace pleinair::app
