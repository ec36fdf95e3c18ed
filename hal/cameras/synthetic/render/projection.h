#pragma once

#include <cstdint>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "hal/cameras/synthetic/world/geometry.h"
#include "hal/pixel_format.h"

namespace pleinair::hal::synthetic {

/// A quantity that changes evenly over the picture: x·px + y·py + one. A facet's 1/depth is one,
/// and u/depth and v/depth are.
struct OverPicture {
  double x = 0, y = 0, one = 0;
  double at(double px, double py) const { return x * px + y * py + one; }
};

/// A facet as a convex outline in the picture. Only what is before the camera is in it.
struct ProjectedFacet {
  struct Edge {
    float x = 0, y = 0;  ///< its upper end, px
    float endY = 0;      ///< > y
    float slope = 0;     ///< dx/dy
  };
  std::uint32_t facet = 0;
  float left = 0, right = 0, top = 0, bottom = 0;  ///< px
  OverPicture inverseDepth, uOverDepth, vOverDepth;
  std::vector<Edge> edges;  ///< those that are not level
};

/// Projects a facet whose solid stands as `cameraFromSolid` says. False where it is turned away,
/// edge-on or behind the camera; `out` keeps its memory.
bool project(const Geometry& geometry, std::uint32_t facet, const glm::dmat4& cameraFromSolid,
             const PinholeIntrinsics& intrinsics, ProjectedFacet& out);

/// Whether a sphere may be before the camera and in the columns and rows of the picture, which is
/// taken to be `marginPx` larger all around.
bool mayShow(const Solid& solid, const glm::dmat4& cameraFromSolid,
             const PinholeIntrinsics& intrinsics, FrameSize size, double marginPx);

}  // namespace pleinair::hal::synthetic
