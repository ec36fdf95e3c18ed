#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/scene/models/model.h"

namespace pleinair::scene {

/// Whether the model declares the directions of strokes on this mesh of it, in place of the
/// curvature's.
bool declaresDirections(const Model& model, const Mesh& mesh);

/// For each triangle of a part's surface (counted from 0 in the part) the declared direction as
/// TriangleForm::along: a line in the triangle's plane, in the mesh's frame. Its length says how
/// clear it is: an axis fades where the surface lies across it, tangents where those of the corners
/// disagree; all are 0 if the picture alone leads. An axis is seen on the part at rest.
/// Precondition: declaresDirections().
std::vector<glm::vec3> declaredDirections(const Model& model, const ModelPart& part,
                                          std::size_t surface);

}  // namespace pleinair::scene
