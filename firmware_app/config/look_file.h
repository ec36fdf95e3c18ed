#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "config/parameter_values.h"

namespace pleinair::app {

/// A look of one's own, in a file: the style, and the values that replace its defaults.
///
///     [painting]
///     style = "watercolor"
///     look = "glazed"        # optional: the built-in look that it starts from
///     [style.watercolor]
///     cell_size = 12
///
/// It is a site file, too: `--config FILE` takes it as well as `--look FILE`.
struct LookFile {
  std::string style;
  config::ParameterValues values;  ///< each with its origin: "FILE:LINE", or the built-in look
};

/// Whether a look's name is that of a file: it ends in .toml.
bool isLookFile(const std::filesystem::path& look);

/// Throws config::ConfigError, with file and line, for a file that cannot be read, for an unknown
/// style, look, key or table, and for a wrong value.
LookFile readLookFile(const std::filesystem::path& file);

/// The text of a look file with these values, apart from defaults that nobody gave.
std::string lookFileText(std::string_view style, const config::ParameterValues& values);

}  // namespace pleinair::app
