#pragma once

#include <cstdint>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "hal/cameras/synthetic/world/geometry.h"
#include "hal/pixel_format.h"

namespace pleinair::hal::synthetic {

/// A linear function of the image coordinates: x·px + y·py + one. For a facet, 1/depth, u/depth and
/// v/depth are such functions.
struct ImageLinear {
  double x = 0, y = 0, one = 0;
  double at(double px, double py) const { return x * px + y * py + one; }
};

/// A facet projected to a convex outline in the image, clipped at the near plane.
struct ProjectedFacet {
  struct Edge {
    float x = 0, y = 0;  ///< its upper end, px
    float endY = 0;      ///< > y
    float slope = 0;     ///< dx/dy
  };
  std::uint32_t facet = 0;
  float left = 0, right = 0, top = 0, bottom = 0;  ///< px
  ImageLinear inverseDepth, uOverDepth, vOverDepth;
  std::vector<Edge> edges;  ///< without the horizontal edges
};

/// Projects a facet of a solid at the pose `cameraFromSolid`. False if the facet faces away, is
/// edge-on or lies behind the camera. `out` keeps its memory.
bool project(const Geometry& geometry, std::uint32_t facet, const glm::dmat4& cameraFromSolid,
             const PinholeIntrinsics& intrinsics, ProjectedFacet& out);

/// Whether a solid's bounding sphere may be visible in the given columns and rows of the image,
/// extended by `marginPx` on all sides.
bool mayBeVisible(const Solid& solid, const glm::dmat4& cameraFromSolid,
                  const PinholeIntrinsics& intrinsics, FrameSize size, double marginPx);

}  // namespace pleinair::hal::synthetic
