#include "pipeline/scene/model_pose.h"

#include <cstddef>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace pleinair::scene {

void poseModel(const Model& model, const std::optional<ClipMoment>&, hal::Duration turning,
               ModelPose& pose) {
  pose.matrices.clear();
  for (const ModelPart& part : model.parts) pose.matrices.push_back(modelFromPart(part, turning));
}

MeshVertex posedVertex(const Model& model, const ModelPart& part, std::size_t surface,
                       std::size_t vertex, const ModelPose& pose) {
  MeshVertex posed = model.surfaces[part.firstSurface + surface].mesh.vertices[vertex];
  const glm::dmat4& modelFromPart = pose.matrices[part.firstMatrix];
  posed.position = glm::vec3(modelFromPart * glm::dvec4(glm::dvec3(posed.position), 1.0));
  posed.normal = glm::vec3(glm::normalize(glm::transpose(glm::inverse(glm::dmat3(modelFromPart))) *
                                          glm::dvec3(posed.normal)));
  return posed;
}

BoundingSphere boundingSphere(const Model& model, const ModelPose&) {
  return boundingSphere(model);
}

}  // namespace pleinair::scene
