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

/// What is known of a step with mistakes.
struct StepReading {
  bool arePartsKnown = true;  ///< those that it shows, removes and fits
  bool isCheckKnown = true;   ///< also that it has none
  bool isWayKnown = true;     ///< where it leads
};

/// Reads the rest of step `index`, and adds each mistake to `faults`. Precondition: the procedure
/// has all steps with their ids, and its tools and warnings; without a model, parts are not looked
/// up.
StepReading readStep(const config::TomlTable& table, Procedure& procedure, std::size_t index,
                     std::vector<config::ConfigError>& faults);

/// An error for each key that no step has.
std::vector<config::ConfigError> unknownStepKeys(const config::TomlTable& table);

}  // namespace pleinair::procedure
