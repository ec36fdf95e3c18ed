#include "pipeline/procedure/step_command.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "config/suggestion.h"

namespace pleinair::procedure {
namespace {

using Kind = StepCommandKind;

struct CommandWord {
  std::string_view word;
  Kind kind;
  std::string_view argument = {};  ///< what follows; empty: nothing
};
constexpr std::array<CommandWord, 11> kCommandWords{{{"next", Kind::kNext},
                                                     {"back", Kind::kBack},
                                                     {"yes", Kind::kYes},
                                                     {"no", Kind::kNo},
                                                     {"uncertain", Kind::kUncertain},
                                                     {"photo", Kind::kPhoto},
                                                     {"value", Kind::kValue, "NUMBER"},
                                                     {"raw", Kind::kRaw},
                                                     {"operator", Kind::kOperator, "NAME"},
                                                     {"sign_off", Kind::kSignOff},
                                                     {"abort", Kind::kAbort}}};
constexpr std::size_t kMaxCommandBytes = 200;

bool isPrintable(std::string_view text) {
  return std::ranges::none_of(text, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 || byte == 0x7F;
  });
}

tl::unexpected<hal::Error> refused(std::string_view text, std::string_view word) {
  std::vector<std::string> words;
  for (const CommandWord& each : kCommandWords) words.emplace_back(each.word);
  const bool isLine = text.size() <= kMaxCommandBytes && isPrintable(text);
  return tl::unexpected(hal::Error{
      .kind = hal::ErrorKind::kInvalidArgument,
      .subject = "command",
      .problem = isLine ? "found " + config::foundText(std::string(word), words)
                        : fmt::format("is no line of at most {} bytes", kMaxCommandBytes),
      .remedy = "one of " + stepCommandForms()});
}

std::string_view withoutSpace(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  const auto first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

/// A decimal point or comma.
std::optional<double> numberIn(std::string_view text) {
  std::string plain(text);
  std::ranges::replace(plain, ',', '.');
  double value = 0.0;
  const char* const end = plain.data() + plain.size();
  const auto read = std::from_chars(plain.data(), end, value);
  if (plain.empty() || read.ec != std::errc{} || read.ptr != end || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

}  // namespace

std::string stepCommandForms() {
  std::string forms;
  for (const CommandWord& each : kCommandWords) {
    if (!forms.empty()) forms += ", ";
    forms += each.word;
    if (!each.argument.empty()) forms += fmt::format(" {}", each.argument);
  }
  return forms;
}

hal::Result<StepCommand> parseStepCommand(std::string_view text) {
  text = withoutSpace(text);
  const std::string_view word = text.substr(0, text.find(' '));
  const std::string_view argument = withoutSpace(text.substr(word.size()));
  const auto found = std::ranges::find(kCommandWords, word, &CommandWord::word);
  if (text.size() > kMaxCommandBytes || !isPrintable(text) || found == kCommandWords.end()) {
    return refused(text, word);
  }
  StepCommand command{.kind = found->kind};
  if (found->argument.empty() != argument.empty()) return refused(text, text);
  if (command.kind == Kind::kOperator) command.operatorName = argument;
  if (command.kind == Kind::kValue) {
    const std::optional<double> value = numberIn(argument);
    if (!value) return refused(text, text);
    command.value = *value;
  }
  return command;
}

std::string textOf(const StepCommand& command) {
  const auto found = std::ranges::find(kCommandWords, command.kind, &CommandWord::kind);
  std::string text(found->word);
  if (command.kind == Kind::kValue) text += fmt::format(" {}", command.value);
  if (command.kind == Kind::kOperator) text += " " + command.operatorName;
  return text;
}

}  // namespace pleinair::procedure
