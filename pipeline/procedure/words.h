#pragma once

#include <span>
#include <string>
#include <string_view>

#include "pipeline/procedure/procedure.h"

namespace pleinair::procedure {

/// Words of the program that stand beside a procedure's own texts.
struct Words {
  std::string_view language;  ///< "de"
  std::string_view step, tools, torque, check, end, theEnd, aborted, photo, comparison;
  std::string_view yes, no, ok, low, high, pass, fail, uncertain, done;
  std::string_view danger, warning, caution, notice;
  // What is asked for, with the keys.
  std::string_view pressDone, pressPhoto, pressValue, pressCompare, pressSignOff, pressBack;
  // Why nothing is shown on the machine.
  std::string_view noTag, tagCovered, moveCloser, notInView, otherTag, tagsContradict;
};

/// In the language's first part ("de-AT": "de") where the program has it, else in English.
const Words& wordsIn(std::string_view language);
/// All that the program has, English first.
std::span<const Words> allWords();

/// A text with its decimal points as the language writes them: "2,5 ± 0,3 Nm" in all but English.
std::string withDecimals(std::string text, std::string_view language);

std::string_view wordOf(const Words& words, Outcome outcome);
/// The signal word of a warning, in capitals.
std::string_view wordOf(const Words& words, WarningLevel level);

}  // namespace pleinair::procedure
