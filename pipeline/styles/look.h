#pragma once

#include <string_view>

namespace pleinair::styles {

/// A named preset of a style. Its values replace the defaults; what a person sets replaces both.
struct Look {
  std::string_view name;  ///< "wet_in_wet"
  std::string_view help;
  std::string_view toml;  ///< a table of the style's parameters, as in a configuration file
};

}  // namespace pleinair::styles
