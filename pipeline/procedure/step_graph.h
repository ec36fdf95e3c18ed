#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "config/config_error.h"
#include "pipeline/procedure/procedure.h"

namespace pleinair::procedure {

/// Steps that nothing leads to, and steps from which no way leads to the end, each at its line.
std::vector<config::ConfigError> wayFaults(const Procedure& procedure, const std::string& file);

/// A mistake at a step's line.
config::ConfigError stepFault(const Procedure& procedure, std::size_t step, const std::string& file,
                              std::string problem, std::string allowed);

}  // namespace pleinair::procedure
