#include "pipeline/procedure/procedure.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace pleinair::procedure {
namespace {

constexpr std::array<std::string_view, 4> kLevelNames{"danger", "warning", "caution", "notice"};
constexpr std::array<std::string_view, 4> kCheckNames{"yes_no", "value", "photo", "compare"};
constexpr std::array<std::string_view, 10> kOutcomeNames{
    "done", "yes", "no", "ok", "low", "high", "taken", "pass", "fail", "uncertain"};

bool isBullet(std::string_view line) {
  return line.starts_with("- ") || line.starts_with("* ");
}

}  // namespace

std::string_view nameOf(WarningLevel level) {
  return kLevelNames.at(static_cast<std::size_t>(level));
}

std::string_view nameOf(CheckKind kind) {
  return kCheckNames.at(static_cast<std::size_t>(kind));
}

std::string_view nameOf(Outcome outcome) {
  return kOutcomeNames.at(static_cast<std::size_t>(outcome));
}

std::optional<Outcome> outcomeNamed(std::string_view name) {
  const auto found = std::ranges::find(kOutcomeNames, name);
  if (found == kOutcomeNames.end()) return std::nullopt;
  return static_cast<Outcome>(found - kOutcomeNames.begin());
}

std::vector<Outcome> outcomesOf(std::optional<CheckKind> kind) {
  if (!kind) return {Outcome::kDone};
  switch (*kind) {
    case CheckKind::kYesNo:
      return {Outcome::kYes, Outcome::kNo};
    case CheckKind::kValue:
      return {Outcome::kOk, Outcome::kLow, Outcome::kHigh};
    case CheckKind::kPhoto:
      return {Outcome::kTaken};
    case CheckKind::kCompare:
      return {Outcome::kPass, Outcome::kFail, Outcome::kUncertain};
  }
  return {};
}

const StepText& Procedure::text(std::size_t step, const std::string& language) const {
  const auto& texts = steps.at(step).text;
  const auto found = texts.find(language);
  return found != texts.end() ? found->second : texts.at(languages.front());
}

std::optional<std::size_t> Procedure::findStep(std::string_view id) const {
  const auto found = std::ranges::find(steps, id, &Step::id);
  if (found == steps.end()) return std::nullopt;
  return static_cast<std::size_t>(found - steps.begin());
}

const std::string& translated(const Procedure& procedure, const Translations& text,
                              const std::string& language) {
  const auto found = text.find(language);
  return found != text.end() ? found->second : text.at(procedure.languages.front());
}

std::string plainText(std::string_view markdown) {
  std::string plain;
  bool isParagraph = false;
  while (!markdown.empty()) {
    const std::size_t end = markdown.find('\n');
    std::string_view line = markdown.substr(0, end);
    markdown.remove_prefix(end == std::string_view::npos ? markdown.size() : end + 1);
    while (line.starts_with(' ')) line.remove_prefix(1);
    if (line.empty()) {
      isParagraph = false;
      continue;
    }
    if (!plain.empty()) plain += isParagraph && !isBullet(line) ? ' ' : '\n';
    if (isBullet(line)) {
      plain += "• ";
      line.remove_prefix(2);
    }
    for (const char each : line) {
      if (each != '*' && each != '`') plain += each;
    }
    isParagraph = true;
  }
  return plain;
}

std::string limitsText(const Check& check) {
  if (check.min && check.max)
    return fmt::format("{:g} … {:g} {}", *check.min, *check.max, check.unit);
  if (check.min) return fmt::format("≥ {:g} {}", *check.min, check.unit);
  if (check.max) return fmt::format("≤ {:g} {}", *check.max, check.unit);
  return check.unit;
}

}  // namespace pleinair::procedure
