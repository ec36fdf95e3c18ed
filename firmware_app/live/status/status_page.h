#pragma once

#include <string>
#include <vector>

#include "pipeline/runtime/status/runtime_status.h"

namespace pleinair::app {

/// The status as a page for people (HTML): what this is, whether all is well, the painting as a
/// small picture, what stands behind it, and links to the pages for programs. It asks for itself
/// again every few seconds, and needs no script and no other server. Any thread.
std::string statusPage(const runtime::RuntimeStatus& status, const std::string& style,
                       const std::vector<std::string>& qualities);

}  // namespace pleinair::app
