#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene/models/mesh.h"

namespace pleinair::scene {

/// A closed polygon in space; the last point joins the first. As projected on the xy plane, its
/// points go against the clock.
using Ring = std::vector<glm::dvec3>;

Ring circleRing(const glm::dvec2& centre, double radius, double z, std::size_t segments);

/// Puts solids of flat and turned faces together from rings. Faces join without gaps where they
/// are given the very same points.
class SolidBuilder {
 public:
  /// Which way the face that is built looks: faces of the lower side of a solid are mirrored.
  enum class Side { kUpper, kLower };

  /// A horizontal triangle or quad, its corners against the clock as seen from above.
  void addFlat(Side side, std::span<const glm::dvec3> corners);
  /// A horizontal face between two rings, `inner` within `outer`; both must be seen whole from the
  /// inside, `centre`, in the order of their angles.
  void addFlatBetween(Side side, const Ring& outer, const Ring& inner, const glm::dvec2& centre);
  /// A band of quads between two rings of equal count, from the first to the second, which on the
  /// upper side lies above it or further in. `normals` has two for each edge of the ring, at its
  /// start and its end.
  void addBand(Side side, const Ring& from, const Ring& to, std::span<const glm::dvec3> normals);
  /// A band between circles about one upright axis, its normals smooth around it.
  void addTurnedBand(Side side, const Ring& from, const Ring& to, const glm::dvec2& centre);

  Mesh take() { return std::move(mesh_); }

 private:
  void addTriangle(Side side, const MeshVertex& a, const MeshVertex& b, const MeshVertex& c);

  Mesh mesh_;
};

}  // namespace pleinair::scene
