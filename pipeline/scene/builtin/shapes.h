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

// Solids for machine parts. All faces point outward; edges with a small angle are smooth.

/// Part of a turn about z, in radians from x towards y.
struct TurnRange {
  double from = 0.0;
  double to = 6.283185307179586;
};

/// The solid of revolution of a section about z. `section` holds points (radius ≥ 0, z) with the
/// solid on the left of each edge. It starts and ends on the axis, or is a closed convex ring where
/// `isRing` (the first point is not repeated). For less than a full turn, the ends of a ring are
/// closed.
Mesh turned(std::span<const glm::dvec2> section, bool isRing, std::size_t segments,
            TurnRange range = {});

/// An upright prism from z = low to high. `outline` is counter-clockwise and wholly visible from
/// the origin.
Mesh prism(std::span<const glm::dvec2> outline, double low, double high);

/// A box with bevelled edges; bevel 0 leaves them sharp.
Mesh bevelledBox(const glm::dvec3& low, const glm::dvec3& high, double bevel);

Mesh sphere(double radius, std::size_t segments, std::size_t rows);

/// A hexagonal head with a washer face, from z = 0 up; `width` across its flats.
Mesh hexHead(double width, double height);

/// A wall from `low` to `high` along x, y and z. Its upper edge has half-round notches about axes
/// along y at its height. Notches lie within the wall, by rising x, and do not touch.
struct Notch {
  double x = 0.0;
  double radius = 0.0;
};
Mesh notchedWall(const glm::dvec3& low, const glm::dvec3& high, std::span<const Notch> notches);

/// A triangular plate in the xz plane with corners (0, 0), (depth, 0), (0, height), from y =
/// −thickness / 2 to thickness / 2.
Mesh gusset(double depth, double height, double thickness);

/// Appends a transformed mesh (rotation or reflection, uniform scale, translation).
void append(Mesh& to, const Mesh& mesh, const glm::dmat4& transform = glm::dmat4(1.0));

}  // namespace pleinair::scene
