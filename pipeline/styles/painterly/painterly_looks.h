#pragma once

#include <span>

#include "pipeline/styles/look.h"

namespace pleinair::styles {

/// The painter's looks; the first is what the defaults are.
std::span<const Look> painterlyLooks();

}  // namespace pleinair::styles
