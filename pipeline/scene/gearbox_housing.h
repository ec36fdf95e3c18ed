#pragma once

#include <vector>

#include <glm/mat4x4.hpp>

#include "pipeline/scene/gearbox_plan.h"
#include "pipeline/scene/mesh.h"

namespace pleinair::scene {

/// The lower half: a tub with bearing seats, flange, ribs and feet.
Mesh housingMesh(const GearboxPlan& plan);
/// The upper half: the same tub turned over, without ribs and feet.
Mesh coverMesh(const GearboxPlan& plan);

/// Where things are fastened: z points out of the hole.
std::vector<glm::dmat4> footBolts(const GearboxPlan& plan);
/// On the flange between the halves.
std::vector<glm::dmat4> flangeBolts(const GearboxPlan& plan);

inline constexpr double kFlangeHeight = 0.007;

}  // namespace pleinair::scene
