#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/cameras/synthetic/world/builder.h"
#include "hal/cameras/synthetic/world/mip_texture.h"

namespace pleinair::hal::synthetic {

/// A pane of the window, in the plane x = kWindowX.
struct Pane {
  glm::vec2 lowYz{0}, highYz{0};
};
inline constexpr float kWindowX = -1.75F;
const std::vector<Pane>& windowPanes();

/// The position of the lamp's bulb, and the direction of its beam.
inline constexpr glm::vec3 kLampAt{0.375F, 0.13F, 0.475F};
inline constexpr glm::vec3 kLampAxis{-0.300F, -0.420F, -0.8565F};  // unit

/// A round source of light with a beam.
struct Lamp {
  glm::vec3 at{0}, axis{0};  ///< axis: the beam's direction, unit
  glm::vec3 light{0};        ///< at one metre, in the middle of the beam
  float radius = 0;
  float edgeCosine = 0, innerCosine = 0;  ///< between them the beam fades
};

/// The light in the room: a low sun through the window's panes, the sky in them, lamps, and the
/// light that the room reflects, with the shadows of every object. All points of a patch use the
/// same rays, so that there is no grain; the rays' origins are spread over each point's lattice
/// cell, so that shadows have no steps. Immutable; thread-safe.
class RoomLight {
 public:
  /// `colours`: the mean colour of each patch, for the light that nearby surfaces reflect. Keeps
  /// references. `hasSpotlight`: whether the spotlight is on, beside the lamp on the bench.
  RoomLight(const std::vector<Occluder>& occluders, const std::vector<glm::vec3>& colours,
            bool hasSpotlight = false);

  /// The light that falls on a patch, sampled on a lattice over its canvas with points on its rims.
  struct Lattice {
    int columns = 0, rows = 0;
    std::vector<glm::vec3> linearRgb;
  };
  Lattice on(const Patch& patch) const;

 private:
  struct Point {
    glm::vec3 point{0}, normal{0}, alongX{0}, alongY{0};  ///< with the lattice's steps
  };
  using Near = std::vector<const Occluder*>;
  glm::vec3 sunAt(const Point& at, const Near& near) const;
  glm::vec3 skyAt(const Point& at, const Near& near) const;
  glm::vec3 lampAt(const Lamp& lamp, const Point& at, const Near& near) const;
  glm::vec3 roomAt(const Point& at, const Near& near) const;
  glm::vec3 colourOf(const Occluder& occluder) const;

  const std::vector<Occluder>& occluders_;
  std::vector<glm::vec3> occluderColours_;
  std::vector<Lamp> lamps_;
};

/// Multiplies the painted colours by the light, with a dither against banding.
void applyLight(const RoomLight::Lattice& light, glm::vec2 half, float texelMetres,
                MipTexture::Level& level);

}  // namespace pleinair::hal::synthetic
