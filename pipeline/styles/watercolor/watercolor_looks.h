#pragma once

#include <span>

#include "pipeline/styles/look.h"

namespace pleinair::styles {

/// The watercolor's looks; the first is what the defaults are.
std::span<const Look> watercolorLooks();

}  // namespace pleinair::styles
