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

/// A variable of the environment, by its whole name.
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
  /// Asserts that there is such a section.
  const ParameterValues& values(std::string_view section) const;
  /// Puts other values of the same list into a section, as a look does.
  void setValues(std::string_view section, ParameterValues values);

  /// All that a file sets. Throws a ConfigError, with file and line, for a wrong value and for a
  /// key or table that is not known here; it says where a misplaced key belongs.
  void apply(const TomlDocument& document);
  /// PREFIX_SECTION_KEY, in capitals, with '_' for '.' and '-'. The origin is the variable's name.
  /// Throws a ConfigError for a wrong value and for a name that begins with the prefix and is of no
  /// key; `others` are further names to list then. A relative path is meant from where we are.
  void apply(const EnvironmentVariable& variable, std::span<const std::string> others = {});
  /// One key, with `origin` to tell where the text came from: "--style". Throws likewise. With
  /// `section`, the key is one of that section's, by its name alone.
  void apply(std::string_view key, std::string_view text, const std::string& origin,
             std::string_view section = {});

  /// Puts a key, which must be known, or it asserts, back to its default.
  void forget(std::string_view key);

  /// The origin of a key, which must be known, or it asserts.
  const std::string& origin(std::string_view key) const;
  /// An error that attributes the place where the value of a key came from, with the line if there
  /// is one. As ConfigFault otherwise.
  ConfigError errorAt(std::string_view key, std::string problem, std::string allowed) const;

  /// TOML that apply() reads back to the same values, under help and before origins as comments.
  /// Throws a ConfigError for a text that is not UTF-8.
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
