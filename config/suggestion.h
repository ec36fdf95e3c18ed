#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace pleinair::config {

/// The candidate of which `word` is most likely a misspelling: a letter or two wrong, missing,
/// extra or swapped, another case, '-' for '_'. Nothing if none is close. The first of equals wins.
std::optional<std::string> nearest(std::string_view word, std::span<const std::string> candidates);

/// "unknown <what>", with a suggestion if there is one: `unknown key (did you mean "edge"?)`.
std::string unknownText(std::string_view what, std::string_view word,
                        std::span<const std::string> candidates);

/// The word in quotes, with a suggestion if there is one: `"celsl" (did you mean "cells"?)`.
std::string foundText(std::string_view word, std::span<const std::string> candidates);

/// "edge, family, id", or "none" if there are none.
std::string listText(std::span<const std::string> names);

}  // namespace pleinair::config
