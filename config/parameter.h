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

enum class ParameterKind { kNumber, kInteger, kSwitch, kChoice, kText, kPath, kSize, kPathList };

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
    std::variant<double, int, bool, ChoiceIndex, std::string, std::filesystem::path, PixelSize,
                 std::vector<std::filesystem::path>>;

/// Description of a parameter for consoles, profiles and `--help`.
struct ParameterDescriptor {
  std::string name;  ///< lower case with underscores, a TOML key: "cell_size"
  std::string help;  ///< one line
  ParameterValue defaultValue;
  NumberRange numberRange;    ///< of a number
  IntegerRange integerRange;  ///< of an integer
  SizeRange sizeRange;        ///< of a size
  LengthRange lengthRange;    ///< of a list
  /// For a choice: its words, by index. For a path and for the elements of a list: words that stand
  /// for something else ("none"); a text that continues one of them after a colon is no path. For a
  /// size: the word for 0x0, if there is one.
  std::vector<std::string> choices;
  /// For a path: names with an argument. "serial:NUMBER" allows any text that begins with
  /// "serial:".
  std::vector<std::string> openChoices;
  /// Which texts a text, or an element of a list, may be; unset: any.
  std::function<bool(std::string_view)> takesText;
  /// For messages. For a text: "a name that ... lists"; for a list: the elements allowed beside the
  /// choices. Empty: any.
  std::string textAllowed;
  std::string pathEnding;  ///< for a path, in either case: ".toml"; empty: any
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

  /// Whether the text may be an element of the list. Precondition: it is a list.
  bool allowsElement(const std::string& text) const;
  /// Whether the text, of a path or of a list's element, is a path, and neither a choice nor an
  /// open choice.
  bool isPath(std::string_view text) const;
  /// The value as a person writes it ("8", "true", "cells"); parse() reads it back exactly. A
  /// list's elements are separated by commas; a comma or backslash of theirs follows a backslash.
  std::string textOf(const ParameterValue& value) const;
  /// Nothing if the text is not an allowed value.
  std::optional<ParameterValue> parse(std::string_view text) const;
  /// The value as TOML: strings in quotes, and paths absolute, so that they are valid in any file.
  /// Throws a ConfigError if it is not UTF-8.
  std::string tomlOf(const ParameterValue& value) const;
  /// The text of a value, or of an element of a list, as a TOML string.
  std::string tomlOfText(std::string text) const;
  /// Text that parse() does not take, for a message: `"celsl" (did you mean "cells"?)`.
  std::string foundIn(std::string_view text) const;
};

/// A list as ParameterDescriptor::textOf() writes it: "window,a\\,b.mp4".
std::string textOfPaths(const std::vector<std::filesystem::path>& paths);

/// The parameters that one style or part of the program has. Immutable.
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
