#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace pleinair::config {

/// The candidate that `word` is most likely a slip of: a letter or two wrong, missing, too many or
/// swapped, another case, '-' for '_'. Nothing where none is near. The first of equals wins.
std::optional<std::string> nearest(std::string_view word, std::span<const std::string> candidates);

/// "unknown <what>", with the near miss if there is one: `unknown key (did you mean "edge"?)`.
std::string unknownText(std::string_view what, std::string_view word,
                        std::span<const std::string> candidates);

/// The word in quotes, with the near miss if there is one: `"celsl" (did you mean "cells"?)`.
std::string foundText(std::string_view word, std::span<const std::string> candidates);

/// "edge, family, id", or "none" where there are none.
std::string listText(std::span<const std::string> names);

}  // namespace pleinair::config
