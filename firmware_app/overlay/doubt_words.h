#pragma once

#include <string_view>

#include "pipeline/overlay/overlay_content.h"

namespace pleinair::app {

/// Why nothing is shown on the machine, in a language as procedure::wordsIn() has it. Empty for
/// kNone.
std::string_view wordsOf(overlay::Doubt doubt, std::string_view language);

}  // namespace pleinair::app
