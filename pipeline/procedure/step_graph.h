#pragma once

#include <string>
#include <vector>

#include "config/config_error.h"
#include "pipeline/procedure/procedure.h"

namespace pleinair::procedure {

/// Mistakes of the way through a procedure, each at its step's line of `file`: steps that nothing
/// leads to, steps from which no way leads to the end, parts that are shown although every way
/// there has removed them, or the outcome that leads there, and parts that are fitted although no
/// way there has removed them.
std::vector<config::ConfigError> graphFaults(const Procedure& procedure, const std::string& file);

}  // namespace pleinair::procedure
