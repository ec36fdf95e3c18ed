#pragma once

#include <cstddef>
#include <vector>

#include "config/config_error.h"
#include "config/toml_reader.h"
#include "pipeline/procedure/procedure.h"

namespace pleinair::procedure {

/// The id and the line of a [[step]]. Throws config::ConfigError for an id that is none, that is
/// reserved, or that an earlier step has.
Step readStepId(const config::TomlTable& table, const Procedure& procedure);

/// Reads the rest of step `index`, and adds each mistake to `faults`. Precondition: the procedure
/// has all steps with their ids, and its tools and warnings; without a model, parts are not looked
/// up. Returns whether it is known which check the step has, if any.
bool readStep(const config::TomlTable& table, Procedure& procedure, std::size_t index,
              std::vector<config::ConfigError>& faults);

/// An error for each key that no step has.
std::vector<config::ConfigError> unknownStepKeys(const config::TomlTable& table);

}  // namespace pleinair::procedure
