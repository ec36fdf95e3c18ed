#pragma once

#include <string>
#include <vector>

#include "config/config_error.h"
#include "pipeline/procedure/procedure.h"

namespace pleinair::procedure {

/// What is likely wrong in a procedure without mistakes in its names: tools and warnings that no
/// step names, steps without text, texts that are a copy of the default language's. `file`: the
/// TOML file, beside which the texts are.
std::vector<config::ConfigError> likelyMistakes(const Procedure& procedure,
                                                const std::string& file);

}  // namespace pleinair::procedure
