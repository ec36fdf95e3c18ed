#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/parameter_values.h"
#include "config/toml_reader.h"

namespace pleinair::config {

/// The parameters of one TOML table.
struct Section {
  std::string name;  ///< "painting", "style.watercolor"; empty: keys before all tables
  std::string help;  ///< one line
  ParameterValues values;
};

/// An environment variable, with its full name.
struct EnvironmentVariable {
  std::string name;
  std::string value;
};

/// A key that has another name now. Whoever still gives the old one is told so.
struct RenamedKey {
  std::string_view old;  ///< with its section: "camera.seed"
  std::string_view now;  ///< "camera.synthetic.seed"
};

/// A value for each parameter of each section, and where it came from. Layers are laid over it, the
/// weakest first; one that fails leaves it as it was. A key is named with its section:
/// "painting.style". A value; one thread at a time.
class Sections {
 public:
  /// Names are unique, also as variables of the environment, or it asserts. `prefix` is what those
  /// begin with: "PLEINAIR_". `renamed` outlives this; its old names are refused, in any layer, by
  /// an error that says the new one. They are no keys, and the new ones are, or it asserts.
  Sections(std::vector<Section> sections, std::string prefix,
           std::span<const RenamedKey> renamed = {});

  std::span<const Section> all() const { return sections_; }
  /// Asserts that the section exists.
  const ParameterValues& values(std::string_view section) const;
  /// Replaces a section's values by others of the same list, as a look does.
  void setValues(std::string_view section, ParameterValues values);

  /// Applies all values of a file. Throws a ConfigError, with file and line, for a wrong value and
  /// for an unknown key or table; for a misplaced key it names the right section.
  void apply(const TomlDocument& document);
  /// Applies PREFIX_SECTION_KEY, in capitals, with '_' for '.' and '-'. The origin is the
  /// variable's name. Throws a ConfigError for a wrong value, and for a name with the prefix that
  /// matches no key; the message then lists `others` too. A relative path is resolved against the
  /// current directory.
  void apply(const EnvironmentVariable& variable, std::span<const std::string> others = {});
  /// Applies one key; `origin` is the source of the text: "--style". Throws as above. With
  /// `section`, `key` is a name within that section.
  void apply(std::string_view key, std::string_view text, const std::string& origin,
             std::string_view section = {});

  /// Resets a key to its default. Asserts that the key is known.
  void forget(std::string_view key);

  /// The origin of a key. Asserts that the key is known.
  const std::string& origin(std::string_view key) const;
  /// An error that names the origin of a key's value, with the line if there is one; otherwise as
  /// ConfigFault.
  ConfigError errorAt(std::string_view key, std::string problem, std::string allowed) const;

  /// TOML that apply() reads back to the same values, with help and origins as comments. Throws a
  /// ConfigError for a text that is not UTF-8.
  std::string toToml(Printed which = Printed::kAll) const;

 private:
  struct Key {
    std::size_t section = 0;
    std::size_t parameter = 0;
  };

  std::optional<Key> find(std::string_view key) const;
  std::optional<Key> findVariable(std::string_view variable) const;
  std::string variableOf(const Section& section, std::string_view parameter) const;
  void set(const Key& key, std::string_view text, const std::string& origin);
  std::vector<std::string> keysIn(std::string_view table) const;
  void refuseUnknownKeys(const TomlTable& table, const std::string& name) const;
  std::string problemOf(std::string_view unknownKey, std::span<const std::string> known) const;
  const RenamedKey* renamedKey(std::string_view key) const;
  ConfigError unknownKey(std::string_view key, const std::string& origin,
                         std::string_view section) const;
  ConfigError unknownVariable(const std::string& name, std::span<const std::string> others) const;

  std::vector<Section> sections_;
  std::string prefix_;
  std::span<const RenamedKey> renamed_;
};

}  // namespace pleinair::config
