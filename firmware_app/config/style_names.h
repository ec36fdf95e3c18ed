#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pleinair::app {

/// All styles' names, in the order of lists.
std::vector<std::string> styleNames();

// Texts for errors about a name that the style does not have: the name in quotes, with the other
// style that has it, or with the name that it is most likely a misspelling of.

/// `"oil" (a look of painterly: --look oil)` of a style's name; `look`: how a look is given,
/// `--look {}` or `look = "{}"`.
std::string foundStyle(const std::string& name, std::string_view look);
/// `"oil" (a look of painterly: --style painterly)`, `"oill" (did you mean "oil", a look of
/// painterly?)` of a look's name in that style.
std::string foundLook(const std::string& name, std::string_view style);
/// The same of a debug view's name.
std::string foundView(const std::string& name, std::string_view style);

}  // namespace pleinair::app
