#pragma once

#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/cameras/synthetic/camera_view.h"

namespace pleinair::hal::synthetic {

/// The floor's plane: z in metres, below the desk's top at 0.
inline constexpr double kFloorZ = -0.72;

/// Whether a point of the plane z = 0 belongs to the desk's top.
bool isOnDesk(glm::dvec2 point);

/// What a ray meets first: the desk's top or the floor; nothing where it points above the horizon.
std::optional<glm::dvec3> surfaceAlong(const Ray& ray);

/// The floor's colour and light, the desk's soft shadow included: linear light at a point in
/// metres.
glm::vec3 floorLinearRgb(glm::vec2 point);

/// What is seen where there is no floor.
glm::vec3 hazeLinearRgb();

}  // namespace pleinair::hal::synthetic
