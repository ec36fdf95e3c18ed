#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "hal/pixel_format.h"

namespace pleinair::hal {

/// A pinhole without distortion, in pixels; the first pixel's centre is at (0.5, 0.5).
struct PinholeIntrinsics {
  double fx = 0, fy = 0;
  double cx = 0, cy = 0;
};

/// The synthetic camera's: square pixels, about 56° across the longer side, the axis in the middle.
PinholeIntrinsics syntheticIntrinsics(FrameSize size);

}  // namespace pleinair::hal

namespace pleinair::hal::synthetic {

/// A line of sight, in world coordinates; the direction's length is not 1.
struct Ray {
  glm::dvec3 origin{0};
  glm::dvec3 direction{0};
};

/// A camera at one moment.
struct CameraView {
  PinholeIntrinsics intrinsics;
  glm::dmat4 cameraFromWorld{1};  ///< rigid; OpenCV's camera frame

  /// The point it looks from, in the world.
  glm::dvec3 eye() const;
  /// Where a world point appears, px; nothing where it is behind the camera.
  std::optional<glm::dvec2> project(glm::dvec3 world) const;
  /// What may be seen at a pixel coordinate.
  Ray through(glm::dvec2 pixel) const;
};

/// A flat, convex piece of a surface, seen from its front only.
struct Facet {
  glm::dvec3 normal{0};  ///< unit, out of the front
  double offset = 0;     ///< normal · p of its points
  std::uint32_t firstCorner = 0;
  std::uint16_t corners = 0;  ///< anticlockwise from the front
  std::uint16_t patch = 0;    ///< whose texture it shows
  glm::dvec4 u{0}, v{0};      ///< of a point on it: dot(xyz, p) + w, metres on the patch's canvas
};

/// Facets that belong together, within a sphere.
struct Solid {
  glm::dvec3 centre{0};
  double radius = 0;
  std::uint32_t firstFacet = 0;
  std::uint32_t facets = 0;
  bool moves = false;  ///< in the mover's coordinates, not the world's
};

/// A point on a surface, in its solid's own coordinates, so that it keeps them when the solid
/// moves.
struct SurfacePoint {
  glm::dvec3 point{0};
  bool moves = false;
  std::uint32_t facet = 0;
};

/// What there is to see: all of it flat and static, but for the solids that move as one.
struct Geometry {
  std::vector<Solid> solids;
  std::vector<Facet> facets;
  std::vector<glm::dvec3> corners;

  std::span<const glm::dvec3> cornersOf(const Facet& facet) const {
    return std::span(corners).subspan(facet.firstCorner, facet.corners);
  }
  /// What a ray meets first; nothing where it leaves the room.
  std::optional<SurfacePoint> firstAlong(const Ray& ray, const glm::dmat4& worldFromMover) const;
};

/// The point in the world.
glm::dvec3 inWorld(const SurfacePoint& point, const glm::dmat4& worldFromMover);

}  // namespace pleinair::hal::synthetic
