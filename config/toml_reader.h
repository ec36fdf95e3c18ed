#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/config_error.h"
#include "config/value_range.h"

namespace pleinair::config {

/// A name in a file, and the value that it stands for.
template <class E>
struct Choice {
  std::string_view name;
  E value;
};

/// The names, in order.
template <class E, std::size_t N>
std::vector<std::string> namesOf(const std::array<Choice<E>, N>& choices) {
  std::vector<std::string> names;
  names.reserve(N);
  for (const Choice<E>& choice : choices) names.emplace_back(choice.name);
  return names;
}

/// A view of one table of a TOML file, read key by key. Copies refer to the same table; the
/// document lives as long as any of them. One thread at a time.
///
/// Each getter marks its key as known, and throws a ConfigError with file, line and key if the
/// value has another type or is out of range. `xyz(key)` also throws if the key is absent;
/// `optionalXyz(key)` returns nothing then. Call finish() after the last getter.
class TomlTable {
 public:
  /// `allowed` appears in the message.
  std::string string(std::string_view key, std::string_view allowed = "a string") const;
  std::optional<std::string> optionalString(std::string_view key,
                                            std::string_view allowed = "a string") const;

  /// Accepts TOML integers too; rejects NaN and infinities.
  double number(std::string_view key, const NumberRange& range = {}) const;
  std::optional<double> optionalNumber(std::string_view key, const NumberRange& range = {}) const;

  int integer(std::string_view key, const IntegerRange& range = {}) const;
  std::optional<int> optionalInteger(std::string_view key, const IntegerRange& range = {}) const;

  /// The words "on" and "off" are taken, too.
  bool boolean(std::string_view key) const;
  std::optional<bool> optionalBoolean(std::string_view key) const;

  /// An array of numbers, each within `range`.
  std::vector<double> numbers(std::string_view key, LengthRange length = {},
                              const NumberRange& range = {}) const;
  std::optional<std::vector<double>> optionalNumbers(std::string_view key, LengthRange length = {},
                                                     const NumberRange& range = {}) const;

  /// An array of exactly N numbers: a vector, a quaternion, a matrix by rows.
  template <std::size_t N>
  std::array<double, N> vector(std::string_view key, const NumberRange& range = {}) const {
    return toArray<N>(numbers(key, {N, N}, range));
  }
  template <std::size_t N>
  std::optional<std::array<double, N>> optionalVector(std::string_view key,
                                                      const NumberRange& range = {}) const {
    const auto values = optionalNumbers(key, {N, N}, range);
    if (!values) return std::nullopt;
    return toArray<N>(*values);
  }

  /// An array of strings; `allowed` is for the message, the whole of it.
  std::optional<std::vector<std::string>> optionalStrings(std::string_view key, LengthRange length,
                                                          std::string_view allowed) const;

  /// A string out of `choices`; gives the index of the one found.
  std::size_t choice(std::string_view key, std::span<const std::string> choices) const;
  std::optional<std::size_t> optionalChoice(std::string_view key,
                                            std::span<const std::string> choices) const;

  /// A string out of `choices`; returns the value that it stands for.
  template <class E, std::size_t N>
  E choice(std::string_view key, const std::array<Choice<E>, N>& choices) const {
    return choices[choice(key, namesOf(choices))].value;
  }
  template <class E, std::size_t N>
  std::optional<E> optionalChoice(std::string_view key,
                                  const std::array<Choice<E>, N>& choices) const {
    const auto index = optionalChoice(key, namesOf(choices));
    if (!index) return std::nullopt;
    return choices[*index].value;
  }

  /// A table within this one; repeated calls give the same view.
  TomlTable table(std::string_view key) const;
  std::optional<TomlTable> optionalTable(std::string_view key) const;

  /// An array of tables, `[[key]]`; empty if absent.
  std::vector<TomlTable> tables(std::string_view key) const;

  // These three do not make the key known.
  bool has(std::string_view key) const;
  bool isString(std::string_view key) const;
  bool isTable(std::string_view key) const;

  std::vector<std::string> keys() const;   ///< every key in the table, sorted
  int lineOf(std::string_view key) const;  ///< where absent, its table's line; 0 for the root
  std::string pathOf(std::string_view key) const;  ///< "tag[0].edge"
  const std::string& file() const;                 ///< the name for messages
  /// Directory of the file, to which its relative paths refer; empty for text.
  const std::filesystem::path& directory() const;

  /// Throws a ConfigError for the first key, here or in a table got from here, that no getter asked
  /// for; it lists the known keys.
  void finish() const;

  /// An error beyond a single value: `problem` as in "id 3 is used twice".
  ConfigError error(std::string_view key, std::string problem, std::string allowed = {}) const;

 private:
  friend class TomlDocument;
  struct State;
  explicit TomlTable(std::shared_ptr<State> state) : state_(std::move(state)) {}

  template <std::size_t N>
  static std::array<double, N> toArray(const std::vector<double>& values) {
    std::array<double, N> array{};
    for (std::size_t i = 0; i < N; ++i) array[i] = values[i];
    return array;
  }

  std::shared_ptr<State> state_;
};

/// A parsed TOML file (TOML 1.0), of at most 1 MiB and 16 levels.
class TomlDocument {
 public:
  /// Throws a ConfigError if the file is missing, unreadable, not a regular file, too large, nested
  /// too deeply, or not TOML.
  static TomlDocument parseFile(const std::filesystem::path& path);
  /// The same as parseFile(), from text. Messages name the file `name`; `directory` is its
  /// directory.
  static TomlDocument parseText(std::string_view text, std::string name,
                                const std::filesystem::path& directory = {});

  const TomlTable& root() const { return root_; }

 private:
  explicit TomlDocument(TomlTable root) : root_(std::move(root)) {}

  TomlTable root_;
};

}  // namespace pleinair::config
