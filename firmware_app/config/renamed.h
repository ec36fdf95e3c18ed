#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "config/sections.h"

namespace pleinair::app {

// Names that users may still have in their files and scripts. Each is refused by an error that says
// the new one; nothing is taken under two names.

/// Keys, as config::Sections wants them.
std::span<const config::RenamedKey> renamedKeys();

/// The option that `option` is now: "--snapshots" of "--stills".
std::optional<std::string_view> renamedOption(std::string_view option);

/// The present name of a value of a key: "filtered" for painting.view's "steady".
std::optional<std::string_view> renamedValue(std::string_view key, std::string_view value);

}  // namespace pleinair::app
