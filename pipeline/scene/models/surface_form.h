#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/scene/models/mesh.h"
#include "pipeline/scene/models/rig.h"

namespace pleinair::scene {

/// How a painter sees a triangle's surroundings at rest.
struct TriangleForm {
  /// The smooth patch that it belongs to, counted from 0 on each mesh. Patches end at creases, and
  /// where the limbs of a skeleton begin; small ones have joined a neighbour.
  std::uint32_t patch = 0;
  bool isOnLimb = false;  ///< of a skeleton, not on its trunk
  /// Where a limb begins on a smooth surface: the triangle touches the border between the patches
  /// of a limb and of the trunk. Painters go on over such a border where the surface does.
  bool isAtJoint = false;
  /// Along the least principal curvature (the axis of a cylinder), in the mesh's frame. Its length
  /// says how clear that is: 1 where the surface bends in one direction only, with a radius at most
  /// 1.25 times the mesh's; 0 where it bends alike in both (a sphere, an even saddle) or hardly at
  /// all, with a radius above five times the mesh's.
  glm::vec3 along{0.0F};
};

/// The forms of all triangles, in order. `limbs`: the limb of each joint of the mesh's skin
/// (limbsOf()); empty without a skin. Curvature: Rusinkiewicz, "Estimating Curvatures and Their
/// Derivatives on Triangle Meshes", 2004, from normals that are smooth within a patch.
std::vector<TriangleForm> formsOf(const Mesh& mesh, std::span<const std::size_t> limbs = {});

/// For each joint of a skin the limb that it belongs to; 0: the trunk. Limbs are long chains of
/// joints that leave the trunk where it branches; what branches off a limb, like fingers, is part
/// of it. A joint below a node that is no joint begins a trunk of its own.
std::vector<std::size_t> limbsOf(const Rig& rig, const Skin& skin);

}  // namespace pleinair::scene
