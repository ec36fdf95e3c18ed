#pragma once

#include <array>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "pipeline/scene/models/mesh.h"
#include "pipeline/scene/models/model.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::app {

/// From where a step's parts are looked at: degrees about the vertical, 0 from the front (−y), and
/// above the ground.
struct ViewAngles {
  double azimuthDeg = 0.0;
  double elevationDeg = 0.0;
};

/// The views that are tried, the usual one first.
std::span<const ViewAngles> candidateViews();

/// The model with these parts only, at rest. Precondition: parts rise.
scene::Model withParts(const scene::Model& model, std::span<const std::size_t> parts);

/// Vertical field of view of the pictures.
inline constexpr double kStepViewDeg = 30.0;

/// The camera of a picture of this size.
tracking::CameraModel stepCamera(hal::FrameSize size);

/// Camera (OpenCV's frame: x right, y down, z ahead) from model, so that `focus` fills about a
/// third of the picture's height, and at least a part of `whole` is seen around it. Both spheres
/// are in the model's frame; angles are about the upright one, whose z is up.
glm::dmat4 cameraFromModel(const ViewAngles& view, const scene::BoundingSphere& focus,
                           const scene::BoundingSphere& whole,
                           const glm::dmat3& uprightFromModel = glm::dmat3(1.0));

/// The same for a close-up of a part, of which the picture's middle circle (kCloseUpShare) is used.
glm::dmat4 closeUpFromModel(const ViewAngles& view, const scene::BoundingSphere& part,
                            const glm::dmat3& uprightFromModel = glm::dmat3(1.0));

}  // namespace pleinair::app
