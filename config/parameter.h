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
  kLive,     ///< takes effect at the next frame
  kRestart,  ///< takes effect when the pipeline is rebuilt
};

/// The selected one of a parameter's choices.
struct ChoiceIndex {
  std::size_t index = 0;
  bool operator==(const ChoiceIndex&) const = default;
};

/// Alternatives in the order of ParameterKind.
using ParameterValue =
    std::variant<double, int, bool, ChoiceIndex, std::string, std::filesystem::path, PixelSize>;

/// Description of a parameter for consoles, profiles and `--help`.
struct ParameterDescriptor {
  std::string name;  ///< lower case with underscores, a TOML key: "cell_size"
  std::string help;  ///< one line
  ParameterValue defaultValue;
  NumberRange numberRange;    ///< for a number
  IntegerRange integerRange;  ///< for an integer
  SizeRange sizeRange;        ///< for a size
  /// For a choice: the names, by index. For a path: words with a meaning of their own ("none");
  /// text that continues one of them after a colon is no path. For a size: the word for 0x0, if
  /// there is one.
  std::vector<std::string> choices;
  /// For a path: names with an argument. "serial:NUMBER" allows any text that begins with
  /// "serial:".
  std::vector<std::string> openChoices;
  /// For a text: whether a text is allowed; unset: any is.
  std::function<bool(std::string_view)> takesText;
  std::string textAllowed;  ///< for a text, in messages: "a name that ... lists"; empty: any
  std::string pathEnding;   ///< for a path: ".toml"; empty: any
  TakesEffect takesEffect = TakesEffect::kLive;

  ParameterKind kind() const { return static_cast<ParameterKind>(defaultValue.index()); }
  /// "px"; empty if there is none.
  std::string_view unit() const;
  /// "a number of px in [2, 64]", "true or false", "one of cells, seeds", "none, or a path".
  std::string allowed() const;
  /// The same, limited to the alternatives that begin like a text with a word before a colon: for
  /// "synthetic:nope" the "synthetic:…" ones.
  std::string allowedInsteadOf(std::string_view text) const;
  /// Whether the value has this parameter's kind and is within its range.
  bool allows(const ParameterValue& value) const;

  /// Whether a text is a path, and neither one of the choices nor of the open choices.
  bool isPath(std::string_view text) const;
  /// The value as people write it ("8", "true", "cells"); parse() reads it back exactly.
  std::string textOf(const ParameterValue& value) const;
  /// Nothing if the text is not an allowed value.
  std::optional<ParameterValue> parse(std::string_view text) const;
  /// The value as TOML: strings in quotes, and paths absolute, so that they are valid in any file.
  /// Throws a ConfigError if it is not UTF-8.
  std::string tomlOf(const ParameterValue& value) const;
  /// A text that parse() rejects, for a message: `"celsl" (did you mean "cells"?)`.
  std::string foundIn(std::string_view text) const;
};

/// The parameters of one style or part of the program. Immutable.
class ParameterList {
 public:
  /// Asserts that names are unique TOML keys and that defaults are allowed values.
  explicit ParameterList(std::vector<ParameterDescriptor> descriptors);

  std::span<const ParameterDescriptor> descriptors() const { return descriptors_; }
  std::optional<std::size_t> indexOf(std::string_view name) const;
  std::vector<std::string> names() const;

 private:
  std::vector<ParameterDescriptor> descriptors_;
};

}  // namespace pleinair::config
