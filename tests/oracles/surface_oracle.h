#pragma once

#include <cstdint>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene/models/model.h"
#include "pipeline/scene/models/model_pose.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::oracles {

/// A model as it stands before the camera at one moment.
struct PosedModel {
  const scene::Model* model = nullptr;
  scene::ModelPose pose;
  glm::dmat4 cameraFromModel{1.0};
};

/// Where the camera sees a point of a triangle, by the triangle's number and barycentrics in the
/// order of its corners in the mesh.
struct TrianglePoint {
  std::size_t part = 0;
  std::size_t surface = 0;   ///< of the part
  std::size_t triangle = 0;  ///< of the surface
  glm::dvec3 barycentrics{0.0};
};

/// What a pixel's centre shows of a triangle, in double: edges are straight in the picture, and the
/// point is linear on the triangle (perspective-correct). Nothing where the triangle has no area in
/// the picture. Precondition: all corners are in front of the camera.
std::optional<TrianglePoint> pointBehind(const PosedModel& posed, std::uint32_t triangle,
                                         const tracking::CameraModel& camera, glm::dvec2 px);

/// Where that point is, camera frame, metres.
glm::dvec3 cameraPoint(const PosedModel& posed, const TrianglePoint& point);
/// And before posing, in its part's frame.
glm::dvec3 restPoint(const scene::Model& model, const TrianglePoint& point);

}  // namespace pleinair::oracles
