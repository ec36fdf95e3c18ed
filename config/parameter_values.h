#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "config/parameter.h"
#include "config/toml_reader.h"

namespace pleinair::config {

/// What ParameterValues::origin() says of a value that nobody gave.
inline constexpr std::string_view kDefaultOrigin = "default";

/// Which values are put into a text.
enum class Printed {
  kAll,
  kGiven  ///< those of another origin than "default"
};

/// A value for each parameter of a list: an immutable snapshot. A copy is a shared pointer's, so it
/// is swapped at a frame boundary at no cost; changes make a new snapshot. Any thread may read one.
/// It knows no style: a style gets its typed struct from its ParameterTable.
class ParameterValues {
 public:
  /// The defaults.
  explicit ParameterValues(std::shared_ptr<const ParameterList> list);

  const ParameterList& list() const { return *data_->list; }
  const ParameterValue& at(std::size_t index) const { return data_->values.at(index); }

  /// As a person writes it. Throws a ConfigError for an unknown name.
  std::string text(std::string_view name) const;
  /// "default", "site.toml:12", or what with() was given. Throws as text() does.
  const std::string& origin(std::string_view name) const;

  /// A snapshot with one value changed, as from a command line or a console. `origin` says where
  /// the text comes from: "--set". Throws a ConfigError for an unknown name or a wrong value.
  [[nodiscard]] ParameterValues with(std::string_view name, std::string_view text,
                                     std::string origin = {}) const;

  /// A snapshot with the values that the table gives. Throws a ConfigError for a wrong value, and
  /// for a key that is no parameter.
  [[nodiscard]] ParameterValues with(const TomlTable& table) const;
  /// As with(), but a key that is no parameter is left to the caller.
  [[nodiscard]] ParameterValues withKnownKeys(const TomlTable& table) const;

  /// A snapshot with the value at `index` changed to one that the descriptor allows, or it asserts.
  [[nodiscard]] ParameterValues with(std::size_t index, ParameterValue value,
                                     std::string origin) const;

  /// The keys of a TOML table, each under its help, range and default and before its origin as
  /// comments. Throws a ConfigError for a text that is not UTF-8.
  std::string toToml(Printed which = Printed::kAll) const;

  /// The same values of the same list, whatever their origins.
  bool operator==(const ParameterValues& other) const;
  /// Whether going from this snapshot to `next`, of the same list, needs a new pipeline.
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
