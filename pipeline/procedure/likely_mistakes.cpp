#include "pipeline/procedure/likely_mistakes.h"

#include <algorithm>
#include <filesystem>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "config/suggestion.h"

namespace pleinair::procedure {
namespace {

using config::ConfigError;

bool isUsed(const Procedure& procedure, std::vector<std::size_t> Step::*member, std::size_t index) {
  return std::ranges::any_of(procedure.steps, [&](const Step& step) {
    return std::ranges::find(step.*member, index) != (step.*member).end();
  });
}

template <class Item>
void addUnused(const Procedure& procedure, const std::vector<Item>& items, const std::string& table,
               std::vector<std::size_t> Step::*member, const std::string& file,
               std::vector<ConfigError>& found) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (isUsed(procedure, member, i)) continue;
    found.push_back(ConfigError({.file = file,
                                 .line = items[i].line,
                                 .key = fmt::format("{}.{}", table, items[i].id),
                                 .problem = "no step names it",
                                 .allowed = fmt::format("{} of a step, or no such line", table)}));
  }
}

const StepText* textOf(const Step& step, const std::string& language) {
  const auto found = step.text.find(language);
  return found != step.text.end() ? &found->second : nullptr;
}

/// A title alone says what, not how.
bool saysNothing(const Step& step, const StepText& text) {
  return text.body.empty() && text.question.empty() && text.pictures.empty() && !step.movie;
}

std::string shortList(std::span<const std::string> names) {
  constexpr std::size_t kShown = 6;
  if (names.size() <= kShown) return config::listText(names);
  return fmt::format("{} and {} more", config::listText(names.first(kShown)),
                     names.size() - kShown);
}

bool isCopy(const Procedure& procedure, const std::string& language) {
  const std::string& first = procedure.languages.front();
  bool hasWords = false;
  for (const Step& step : procedure.steps) {
    const StepText* const text = textOf(step, language);
    const StepText* const original = textOf(step, first);
    if (text == nullptr || original == nullptr) return false;
    if (text->title != original->title || text->body != original->body ||
        text->question != original->question) {
      return false;
    }
    hasWords = hasWords || !text->body.empty() || !text->question.empty();
  }
  return hasWords;
}

void addTextFindings(const Procedure& procedure, const std::string& language,
                     const std::string& file, std::vector<ConfigError>& found) {
  std::vector<std::string> silent;
  for (const Step& step : procedure.steps) {
    const StepText* const text = textOf(step, language);
    if (text != nullptr && saysNothing(step, *text)) silent.push_back(step.id);
  }
  if (!silent.empty()) {
    found.push_back(
        ConfigError({.file = file,
                     .problem = "nothing stands below the heading of " + shortList(silent),
                     .allowed = "what to do there, a picture, or a question"}));
  }
  if (language != procedure.languages.front() && isCopy(procedure, language)) {
    found.push_back(
        ConfigError({.file = file,
                     .problem = fmt::format("says the same as {}.md", procedure.languages.front()),
                     .allowed = fmt::format("the texts in \"{}\"", language)}));
  }
}

}  // namespace

std::vector<ConfigError> likelyMistakes(const Procedure& procedure, const std::string& file) {
  std::vector<ConfigError> found;
  addUnused(procedure, procedure.tools, "tools", &Step::tools, file, found);
  addUnused(procedure, procedure.warnings, "warnings", &Step::warnings, file, found);
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  for (const std::string& language : procedure.languages) {
    addTextFindings(procedure, language, (folder / (language + ".md")).string(), found);
  }
  return found;
}

}  // namespace pleinair::procedure
