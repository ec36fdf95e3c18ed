#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "pipeline/scene/models/model.h"

namespace pleinair::procedure {

/// The first version of a procedure, to be edited.
struct Skeleton {
  std::string toml;
  std::map<std::string, std::string> texts;  ///< by language
  std::size_t steps = 0;
  std::vector<std::string> leftOut;  ///< nodes beyond the largest number of steps
};

/// A step for each node of the model, in its order; numbered ones (bolt_1, bolt_2 …) share a step.
/// `source`: what [model] names; `units`: of its lengths, empty: not said. Precondition: at least
/// one language.
Skeleton skeletonOf(const scene::Model& model, const std::string& name, const std::string& source,
                    const std::string& units, std::span<const std::string> languages);

}  // namespace pleinair::procedure
