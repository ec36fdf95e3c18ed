#pragma once

#include <string>
#include <string_view>

#include "pipeline/overlay/overlay_content.h"

namespace pleinair::app {

/// Why nothing is shown on the machine, in English or German by the language's first part; English
/// for others. Empty for kNone.
std::string wordsOf(overlay::Doubt doubt, std::string_view language);

}  // namespace pleinair::app
