#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene/models/mesh.h"

namespace pleinair::scene {

/// A closed polygon in space; the last point joins the first. Projected to the xy plane, its points
/// are counter-clockwise.
using Ring = std::vector<glm::dvec3>;

Ring circleRing(const glm::dvec2& centre, double radius, double z, std::size_t segments);

/// Builds solids of flat and turned faces from rings. Faces join without gaps where they are given
/// the very same points.
class SolidBuilder {
 public:
  /// The side of the solid that a face belongs to. Faces of the lower side are mirrored.
  enum class Side { kUpper, kLower };

  /// Adds a horizontal triangle or quad, its corners counter-clockwise as seen from above.
  void addFlat(Side side, std::span<const glm::dvec3> corners);
  /// Adds a horizontal face between two rings, `inner` within `outer`. Both must be wholly visible
  /// from `centre`, in the order of their angles.
  void addFlatBetween(Side side, const Ring& outer, const Ring& inner, const glm::dvec2& centre);
  /// Adds a band of quads between two rings of equal count. On the upper side, the second ring lies
  /// above the first or further in. `normals` has two for each edge of the ring, at its start and
  /// its end.
  void addBand(Side side, const Ring& from, const Ring& to, std::span<const glm::dvec3> normals);
  /// Adds a band between circles about one upright axis, with smooth normals around it.
  void addTurnedBand(Side side, const Ring& from, const Ring& to, const glm::dvec2& centre);

  Mesh take() { return std::move(mesh_); }

 private:
  void addTriangle(Side side, const MeshVertex& a, const MeshVertex& b, const MeshVertex& c);

  Mesh mesh_;
};

}  // namespace pleinair::scene
