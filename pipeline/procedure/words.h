#pragma once

#include <string_view>

#include "pipeline/procedure/procedure.h"

namespace pleinair::procedure {

/// Words that stand beside a procedure's own texts.
struct Words {
  std::string_view step, tools, torque, check, end, photo, comparison;
  std::string_view yes, no, ok, low, high, pass, fail, uncertain, done;
  std::string_view danger, warning, caution, notice;
};

/// In English or German by the language's first part ("de-AT"); English for others.
const Words& wordsIn(std::string_view language);

std::string_view wordOf(const Words& words, Outcome outcome);
/// The signal word of a warning, in capitals.
std::string_view wordOf(const Words& words, WarningLevel level);

}  // namespace pleinair::procedure
