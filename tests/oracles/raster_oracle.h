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

/// A mesh and where it is: a rotation, a uniform scale and a translation.
struct PlacedMesh {
  const scene::Mesh* mesh = nullptr;
  glm::dmat4 cameraFromModel{1.0};
};

/// What a pixel's centre shows.
struct RasterPixel {
  std::uint32_t id = 0;          ///< as scene::ArFrame::ids
  double depthMetres = 0.0;      ///< along the camera's axis
  glm::dvec3 cameraNormal{0.0};  ///< unit, interpolated; zero where no model is
  glm::dvec2 texture{0.0};       ///< the vertices' attributes, interpolated
  glm::dvec4 colour{0.0};
  /// An edge of a triangle that faces the camera is this near, in pixels; large where none is.
  double edgeDistancePx = 1e9;
};

/// Every pixel centre against every triangle that faces the camera, in double: vertices go through
/// the camera model, edges between them are straight in the picture, and attributes are linear on
/// the triangle (perspective-correct). Precondition: all vertices are in front of the camera.
std::vector<RasterPixel> rasterise(std::span<const PlacedMesh> meshes,
                                   const tracking::CameraModel& camera);

/// The factor of thesis §3.2.2's toon shader.
double toonBand(double intensity);

}  // namespace pleinair::oracles
