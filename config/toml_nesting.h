#pragma once

#include <optional>
#include <string_view>

namespace pleinair::config {

/// The line (from 1) where TOML text first nests more than `limit` brackets or joins more than
/// `limit` keys by dots; nothing if it never does. Text that is not TOML may give either answer.
/// toml++ limits brackets but not dots, and builds and destroys tables by recursion, so a long
/// dotted key would overflow the stack.
std::optional<int> lineNestedTooDeep(std::string_view text, int limit);

}  // namespace pleinair::config
