#pragma once

#include <vector>

#include <glm/mat4x4.hpp>

#include "pipeline/scene/builtin/gearbox_plan.h"
#include "pipeline/scene/models/mesh.h"

namespace pleinair::scene {

/// The lower half: a tub with bearing seats, flange, ribs and feet.
Mesh housingMesh(const GearboxPlan& plan);
/// The upper half: the same tub upside down, without ribs and feet.
Mesh coverMesh(const GearboxPlan& plan);

/// Frames of the bolts in the feet: z points out of the hole.
std::vector<glm::dmat4> footBolts(const GearboxPlan& plan);
/// Frames of the bolts on the flange between the halves.
std::vector<glm::dmat4> flangeBolts(const GearboxPlan& plan);

inline constexpr double kFlangeHeight = 0.007;

// Rotating parts of a gearbox, and their bearings and covers. The z axis of each mesh is its axis
// of rotation, from the back (0 at the housing's centre) to the reader.

/// A shaft with shoulders for its gears and bearings. An end outside of the housing is a seat for a
/// coupling; the output's has a keyway.
Mesh inputShaftMesh(const GearboxPlan& plan);
Mesh intermediateShaftMesh(const GearboxPlan& plan);
Mesh outputShaftMesh(const GearboxPlan& plan);
Mesh outputKeyMesh();
/// A flange with a hub, without its bolts.
Mesh couplingMesh();
inline constexpr double kCouplingBoltCircle = 0.0155;
inline constexpr double kCouplingFace = 0.072;

// A bearing's centre is at z = 0.
Mesh outerRaceMesh(const GearboxPlan::Shaft& shaft);
Mesh innerRaceMesh(const GearboxPlan::Shaft& shaft);
/// The balls, and separately the cage between them.
Mesh ballsMesh(const GearboxPlan::Shaft& shaft);
Mesh cageMesh(const GearboxPlan::Shaft& shaft);
/// Angle by which the balls move around per angle of their shaft.
double cageRatio(const GearboxPlan::Shaft& shaft);

/// A round plate over the end of a bearing; its outside faces +z, from 0 up.
Mesh endCoverMesh(const GearboxPlan::Shaft& shaft);

}  // namespace pleinair::scene
