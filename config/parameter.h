#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "config/value_range.h"

namespace pleinair::config {

enum class ParameterKind { kNumber, kInteger, kSwitch, kChoice, kText, kPath, kSize };

enum class TakesEffect {
  kLive,     ///< at the next frame
  kRestart,  ///< when the pipeline is built anew
};

/// Which of a parameter's choices is meant.
struct ChoiceIndex {
  std::size_t index = 0;
  bool operator==(const ChoiceIndex&) const = default;
};

/// In the order of ParameterKind.
using ParameterValue =
    std::variant<double, int, bool, ChoiceIndex, std::string, std::filesystem::path, PixelSize>;

/// What consoles, profiles and `--help` know of a parameter.
struct ParameterDescriptor {
  std::string name;  ///< lower case with underscores, a TOML key: "cell_size"
  std::string help;  ///< one line
  ParameterValue defaultValue;
  NumberRange numberRange;    ///< of a number
  IntegerRange integerRange;  ///< of an integer
  SizeRange sizeRange;        ///< of a size
  /// Of a choice, by index. Of a path, words that stand for something else ("none"); text that goes
  /// on from one of them after a colon is no path. Of a size, what stands for 0x0, if anything.
  std::vector<std::string> choices;
  /// Of a path, names of other things, with what follows them: "serial:NUMBER" allows any text that
  /// goes on from "serial:".
  std::vector<std::string> openChoices;
  /// Which texts a text may be; unset: any.
  std::function<bool(std::string_view)> takesText;
  std::string textAllowed;  ///< of a text, for messages: "a name that ... lists"; empty: any
  std::string pathEnding;   ///< of a path, in either case: ".toml"; empty: any
  TakesEffect takesEffect = TakesEffect::kLive;

  ParameterKind kind() const { return static_cast<ParameterKind>(defaultValue.index()); }
  /// "px"; empty where there is none.
  std::string_view unit() const;
  /// "a number of px in [2, 64]", "true or false", "one of cells, seeds", "none, or a path".
  std::string allowed() const;
  /// The same, but only what begins like a text that goes on from a word: of "synthetic:nope" the
  /// "synthetic:…".
  std::string allowedInsteadOf(std::string_view text) const;
  /// Of this parameter's kind and within its range.
  bool allows(const ParameterValue& value) const;

  /// Of a path's text: that it is one, and neither of the choices nor of the open choices.
  bool isPath(std::string_view text) const;
  /// The value as a person writes it ("8", "true", "cells"); parse() reads it back exactly.
  std::string textOf(const ParameterValue& value) const;
  /// Nothing where the text is not an allowed value.
  std::optional<ParameterValue> parse(std::string_view text) const;
  /// The value as TOML: strings in quotes, and paths absolute, so that they hold in any file.
  /// Throws a ConfigError where it is not UTF-8.
  std::string tomlOf(const ParameterValue& value) const;
  /// Text that parse() does not take, for a message: `"celsl" (did you mean "cells"?)`.
  std::string foundIn(std::string_view text) const;
};

/// The parameters that one style or part of the program has. Immutable.
class ParameterList {
 public:
  /// Names are unique TOML keys and defaults are allowed values, or it asserts.
  explicit ParameterList(std::vector<ParameterDescriptor> descriptors);

  std::span<const ParameterDescriptor> descriptors() const { return descriptors_; }
  std::optional<std::size_t> indexOf(std::string_view name) const;
  std::vector<std::string> names() const;

 private:
  std::vector<ParameterDescriptor> descriptors_;
};

}  // namespace pleinair::config
