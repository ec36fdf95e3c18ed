#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "hal/cameras/synthetic/world/bodies.h"
#include "hal/pixel_format.h"

namespace pleinair::hal {

/// A pinhole without distortion, in pixels; the first pixel's centre is at (0.5, 0.5).
struct PinholeIntrinsics {
  double fx = 0, fy = 0;
  double cx = 0, cy = 0;
};

/// The synthetic camera's intrinsics: square pixels, about 56° across the longer side, the
/// principal point in the middle.
PinholeIntrinsics syntheticIntrinsics(FrameSize size);

}  // namespace pleinair::hal

namespace pleinair::hal::synthetic {

/// A ray in world coordinates; the direction is not normalized.
struct Ray {
  glm::dvec3 origin{0};
  glm::dvec3 direction{0};
};

/// The camera at one time.
struct CameraView {
  PinholeIntrinsics intrinsics;
  glm::dmat4 cameraFromWorld{1};  ///< rigid; OpenCV's camera frame

  /// The camera's centre of projection, in the world.
  glm::dvec3 eye() const;
  /// Projects a world point to the image, px; nothing if the point is behind the camera.
  std::optional<glm::dvec2> project(glm::dvec3 world) const;
  /// The ray through a pixel coordinate.
  Ray through(glm::dvec2 pixel) const;
};

/// A flat, convex part of a surface, visible from its front only.
struct Facet {
  glm::dvec3 normal{0};  ///< unit vector, towards the front
  double offset = 0;     ///< normal · p for each point p of the facet
  std::uint32_t firstCorner = 0;
  std::uint16_t corners = 0;  ///< anticlockwise seen from the front
  std::uint16_t patch = 0;    ///< index of the patch that holds its texture
  glm::dvec4 u{0}, v{0};      ///< canvas coordinates of a point p: dot(xyz, p) + w, metres
};

/// A group of facets with a bounding sphere.
struct Solid {
  glm::dvec3 centre{0};
  double radius = 0;
  std::uint32_t firstFacet = 0;
  std::uint32_t facets = 0;
  Body body = kRoom;  ///< in whose coordinates it is
};

/// A point on a surface, in its body's own coordinates, which stay the same when the body moves.
struct SurfacePoint {
  glm::dvec3 point{0};
  Body body = kRoom;
  std::uint32_t facet = 0;
};

/// The scene's geometry: flat facets in solids, each of which moves with its body.
struct Geometry {
  std::vector<Solid> solids;
  std::vector<Facet> facets;
  std::vector<glm::dvec3> corners;

  std::span<const glm::dvec3> cornersOf(const Facet& facet) const {
    return std::span(corners).subspan(facet.firstCorner, facet.corners);
  }
  /// The first surface point along a ray; nothing if the ray leaves the room.
  std::optional<SurfacePoint> firstAlong(const Ray& ray, const BodyPoses& bodies) const;
};

/// The point in world coordinates, its body being at `worldFromBody`.
glm::dvec3 inWorld(const SurfacePoint& point, const glm::dmat4& worldFromBody);

}  // namespace pleinair::hal::synthetic
