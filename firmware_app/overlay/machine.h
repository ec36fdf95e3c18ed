#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "pipeline/inspection/part_window.h"
#include "pipeline/procedure/procedure.h"
#include "pipeline/scene/description/scene.h"

namespace pleinair::app {

/// The model of the scene that a procedure is about. `name`: its name, or "auto": the only model,
/// or the only one whose source is of the same kind or file as the procedure's. Throws hal::Failure
/// that lists the models.
std::size_t machineIn(const scene::Scene& scene, const procedure::Procedure& procedure,
                      const std::string& name);

/// The scene says where a machine stands, the procedure what it is made of: puts the procedure's
/// model in the place of that of the scene. Parts stand still, as on a machine under repair. A
/// file's `up` is the scene's, where that has a file, too. Throws hal::Failure where both have
/// other units.
void putMachine(scene::Scene& scene, std::size_t machine, const procedure::Procedure& procedure);

/// Parts of a model at rest, in its frame.
struct PartSurface {
  scene::BoundingSphere sphere;
  std::vector<inspection::PartTriangle> triangles;  ///< parts are numbered as asked for
};
PartSurface surfaceOfParts(const scene::Model& model, std::span<const std::size_t> parts);

}  // namespace pleinair::app
