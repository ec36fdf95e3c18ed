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

/// A model posed before the camera.
struct PosedModel {
  const scene::Model* model = nullptr;
  scene::ModelPose pose;
  glm::dmat4 cameraFromModel{1.0};
};

/// A point of a triangle: the triangle's number, and barycentrics in the order of its corners in
/// the mesh.
struct TrianglePoint {
  std::size_t part = 0;
  std::size_t surface = 0;   ///< in the part
  std::size_t triangle = 0;  ///< in the surface
  glm::dvec3 barycentrics{0.0};
};

/// The point of a triangle at a pixel's centre, in double: edges are straight in the image, and the
/// point is linear on the triangle (perspective-correct). Nothing for a triangle without area in
/// the image. Precondition: all corners are in front of the camera.
std::optional<TrianglePoint> pointBehind(const PosedModel& posed, std::uint32_t triangle,
                                         const tracking::CameraModel& camera, glm::dvec2 px);

/// The position of that point, camera frame, metres.
glm::dvec3 cameraPoint(const PosedModel& posed, const TrianglePoint& point);
/// The position of that point before posing, in its part's frame.
glm::dvec3 restPoint(const scene::Model& model, const TrianglePoint& point);

}  // namespace pleinair::oracles
