#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace pleinair::config {

/// The text as a TOML string in quotes; nothing if it is not UTF-8.
std::optional<std::string> tomlString(std::string_view text);

/// The text made fit for a TOML comment: one line, '?' for bytes that are not UTF-8 and for control
/// characters.
std::string tomlComment(std::string_view text);

}  // namespace pleinair::config
