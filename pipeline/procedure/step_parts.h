#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "config/config_error.h"
#include "pipeline/procedure/procedure.h"

namespace pleinair::procedure {

/// Mistakes with parts. Warnings: what only some ways do wrong, which people's answers may exclude.
struct PartFindings {
  std::vector<config::ConfigError> faults;
  std::vector<config::ConfigError> warnings;
};

/// Parts that are shown or removed although they are off by then, or fitted although they are on,
/// and the outcomes that lead to such a step. Precondition: the procedure has its model.
PartFindings partFindings(const Procedure& procedure, const std::string& file);

/// Parts that are off when the procedure ends; indices in Model::parts, rising.
struct PartsLeftOff {
  std::vector<std::size_t> onEveryWay, onSomeWays;
};
/// Precondition: the procedure has its model.
PartsLeftOff partsLeftOff(const Procedure& procedure);

}  // namespace pleinair::procedure
