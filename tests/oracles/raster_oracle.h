#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "pipeline/scene/models/mesh.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::oracles {

/// A mesh and its pose: a rotation, a uniform scale and a translation.
struct PlacedMesh {
  const scene::Mesh* mesh = nullptr;
  glm::dmat4 cameraFromModel{1.0};
};

/// The content of a pixel's centre.
struct RasterPixel {
  std::uint32_t id = 0;          ///< as in scene::ArFrame::ids
  double depthMetres = 0.0;      ///< along the camera's axis
  glm::dvec3 cameraNormal{0.0};  ///< unit vector, interpolated; zero without a model
  glm::dvec2 texture{0.0};       ///< the vertices' attributes, interpolated
  glm::dvec4 colour{0.0};
  /// Distance of the nearest edge of a front-facing triangle, in pixels; large if there is none.
  double edgeDistancePx = 1e9;
};

/// Tests every pixel centre against every front-facing triangle, in double: vertices go through the
/// camera model, edges between them are straight in the image, and attributes are linear on the
/// triangle (perspective-correct). Precondition: all vertices are in front of the camera.
std::vector<RasterPixel> rasterise(std::span<const PlacedMesh> meshes,
                                   const tracking::CameraModel& camera);

/// The factor of thesis §3.2.2's toon shader.
double toonBand(double intensity);

}  // namespace pleinair::oracles
