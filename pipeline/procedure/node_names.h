#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/scene/models/model.h"

namespace pleinair::procedure {

/// The names of a model's nodes, each once, in the model's order.
std::vector<std::string> nodeNames(const scene::Model& model);

/// Indices in Model::parts of what a procedure's name stands for: all of that name; "bolt_*",
/// whose names begin so; "piston#2", the second of several. Empty for an unknown name.
std::vector<std::size_t> partsNamed(const scene::Model& model, std::string_view name);

/// The shortest names that stand for just these parts: "piston" for all of that name, "piston#2"
/// for one of several. Precondition: each part is there once.
std::vector<std::string> namesOfParts(const scene::Model& model,
                                      std::span<const std::size_t> parts);

/// The text of a message about a name that no node has, with the nearest name that one has.
std::string unknownNodeText(const std::string& name, const scene::Model& model);

}  // namespace pleinair::procedure
