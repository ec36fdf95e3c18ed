#pragma once

#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene/models/mesh.h"

namespace pleinair::scene {

inline constexpr double kTurn = 2.0 * std::numbers::pi;  ///< a full turn, in radians

// Solids that machines are made of. All face outward; edges that turn little are round.

/// Part of a turn about z, radians from x towards y.
struct TurnRange {
  double from = 0.0;
  double to = 6.283185307179586;
};

/// What a section turned about z makes. `section` is of points (radius ≥ 0, z) with the solid on
/// the left of each edge; it starts and ends on the axis, or is a closed ring where `isRing` (the
/// first point is not repeated; it is convex). Of less than a turn, a ring's ends are closed.
Mesh turned(std::span<const glm::dvec2> section, bool isRing, std::size_t segments,
            TurnRange range = {});

/// An upright prism from z = low to high. `outline` goes against the clock, and all of it is seen
/// from the origin.
Mesh prism(std::span<const glm::dvec2> outline, double low, double high);

/// A box with bevelled edges; bevel 0 leaves them sharp.
Mesh bevelledBox(const glm::dvec3& low, const glm::dvec3& high, double bevel);

Mesh sphere(double radius, std::size_t segments, std::size_t rows);

/// A hexagonal head with a washer's face, from z = 0 up; `width` across its flats.
Mesh hexHead(double width, double height);

/// A wall from `low` to `high` along x, y and z whose upper edge has half-round notches about axes
/// along y at its height. Notches lie within the wall, by rising x, and do not meet.
struct Notch {
  double x = 0.0;
  double radius = 0.0;
};
Mesh notchedWall(const glm::dvec3& low, const glm::dvec3& high, std::span<const Notch> notches);

/// A triangular plate in the plane of x and z with corners (0, 0), (depth, 0), (0, height), from
/// y = −thickness / 2 to thickness / 2.
Mesh gusset(double depth, double height, double thickness);

/// Adds a mesh, transformed (a rotation or reflection, uniform scale, translation).
void append(Mesh& to, const Mesh& mesh, const glm::dmat4& transform = glm::dmat4(1.0));

}  // namespace pleinair::scene
