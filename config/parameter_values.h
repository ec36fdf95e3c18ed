#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "config/parameter.h"
#include "config/toml_reader.h"

namespace pleinair::config {

/// ParameterValues::origin() of a value that was not set.
inline constexpr std::string_view kDefaultOrigin = "default";

/// The values to write into a text.
enum class Printed {
  kAll,
  kGiven  ///< values whose origin is not "default"
};

/// A value for each parameter of a list: an immutable parameter set. A copy shares its data, so
/// replacing a set at a frame boundary costs nothing; changes make a new set. Any thread may read
/// one. It does not depend on styles: a style gets its typed struct from its ParameterTable.
class ParameterValues {
 public:
  /// All parameters have their defaults.
  explicit ParameterValues(std::shared_ptr<const ParameterList> list);

  const ParameterList& list() const { return *data_->list; }
  const ParameterValue& at(std::size_t index) const { return data_->values.at(index); }

  /// The value as people write it. Throws a ConfigError for an unknown name.
  std::string text(std::string_view name) const;
  /// "default", "site.toml:12", or the origin given to with(). Throws as text() does.
  const std::string& origin(std::string_view name) const;

  /// A set with one value changed, as from a command line or a console. `origin` is the source
  /// of the text: "--set". Throws a ConfigError for an unknown name or a wrong value.
  [[nodiscard]] ParameterValues with(std::string_view name, std::string_view text,
                                     std::string origin = {}) const;

  /// A set with the values from a table. Throws a ConfigError for a wrong value, and for a key
  /// that is no parameter.
  [[nodiscard]] ParameterValues with(const TomlTable& table) const;
  /// The same as with(), but a key that is no parameter is left to the caller.
  [[nodiscard]] ParameterValues withKnownKeys(const TomlTable& table) const;

  /// A set with the value at `index` changed. Asserts that the descriptor allows the value.
  [[nodiscard]] ParameterValues with(std::size_t index, ParameterValue value,
                                     std::string origin) const;

  /// The values as keys of a TOML table, each with help, range, default and origin as comments.
  /// Throws a ConfigError for a text that is not UTF-8.
  std::string toToml(Printed which = Printed::kAll) const;

  /// Whether both have the same values of the same list, whatever their origins.
  bool operator==(const ParameterValues& other) const;
  /// Whether changing from this set to `next`, of the same list, needs a new pipeline.
  bool needsRestartFor(const ParameterValues& next) const;

 private:
  struct Data {
    std::shared_ptr<const ParameterList> list;
    std::vector<ParameterValue> values;
    std::vector<std::string> origins;
  };

  std::size_t indexOf(std::string_view name, const std::string& origin) const;

  std::shared_ptr<const Data> data_;
};

}  // namespace pleinair::config
