#pragma once

#include <vector>

#include <glm/mat4x4.hpp>

#include "pipeline/scene/builtin/gearbox_plan.h"
#include "pipeline/scene/models/mesh.h"

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

// What turns in a gearbox, and what holds it. Each mesh's z axis is the one it turns about, from
// the back (0 in the middle of the housing) to the reader.

/// A shaft with shoulders for its gears and bearings; those that leave the housing end in a seat
/// for a coupling, the output's with a keyway.
Mesh inputShaftMesh(const GearboxPlan& plan);
Mesh intermediateShaftMesh(const GearboxPlan& plan);
Mesh outputShaftMesh(const GearboxPlan& plan);
Mesh outputKeyMesh();
/// A flange with a hub, without its bolts.
Mesh couplingMesh();
inline constexpr double kCouplingBoltCircle = 0.0155;
inline constexpr double kCouplingFace = 0.072;

// A bearing's middle is at z = 0.
Mesh outerRaceMesh(const GearboxPlan::Shaft& shaft);
Mesh innerRaceMesh(const GearboxPlan::Shaft& shaft);
/// Balls and the cage between them, apart.
Mesh ballsMesh(const GearboxPlan::Shaft& shaft);
Mesh cageMesh(const GearboxPlan::Shaft& shaft);
/// How fast balls go round for each radian of their shaft.
double cageRatio(const GearboxPlan::Shaft& shaft);

/// A round plate over a bearing's end; its outside is towards z, from 0 up.
Mesh endCoverMesh(const GearboxPlan::Shaft& shaft);

}  // namespace pleinair::scene
