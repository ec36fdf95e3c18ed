#pragma once

#include <glm/mat4x4.hpp>

#include "pipeline/scene/mesh.h"

namespace pleinair::scene {

/// So much longer an affine transform makes anything at most: never too little, and exact where its
/// axes stay perpendicular.
double largestScale(const glm::dmat4& transform);

/// Around what the sphere holds, once it is transformed.
BoundingSphere transformed(const BoundingSphere& sphere, const glm::dmat4& transform);

/// What takes normals along, to within their length: the matrix of cofactors, which unlike the
/// inverse always exists, with the sign that keeps them outward where `linear` mirrors.
glm::dmat3 normalsAlong(const glm::dmat3& linear);

}  // namespace pleinair::scene
