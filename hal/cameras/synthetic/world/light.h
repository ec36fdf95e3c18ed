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

/// The lamp's bulb, and where the lamp points.
inline constexpr glm::vec3 kLampAt{0.375F, 0.13F, 0.475F};
inline constexpr glm::vec3 kLampAxis{-0.300F, -0.420F, -0.8565F};  // unit

/// The light in the room: a low sun through the window's panes, the sky in them, a lamp, and what
/// the room throws back, with the shadows of everything that stands there. Each of a patch's points
/// uses the same rays, so that there is no grain, and rays start all over a point's cell, so that
/// shadows have no steps. Immutable; thread-safe.
class RoomLight {
 public:
  /// `colours`: the mean colour of each patch, for what is thrown back nearby. Keeps references.
  RoomLight(const std::vector<Occluder>& occluders, const std::vector<glm::vec3>& colours);

  /// What falls on a patch, on a lattice over its canvas with points on its rims.
  struct Lattice {
    int columns = 0, rows = 0;
    std::vector<glm::vec3> linearRgb;
  };
  Lattice on(const Patch& patch) const;

 private:
  struct Point {
    glm::vec3 point{0}, normal{0}, alongX{0}, alongY{0};  ///< the lattice's steps
  };
  using Near = std::vector<const Occluder*>;
  glm::vec3 sunAt(const Point& at, const Near& near) const;
  glm::vec3 skyAt(const Point& at, const Near& near) const;
  glm::vec3 lampAt(const Point& at, const Near& near) const;
  glm::vec3 roomAt(const Point& at, const Near& near) const;
  glm::vec3 colourOf(const Occluder& occluder) const;

  const std::vector<Occluder>& occluders_;
  std::vector<glm::vec3> occluderColours_;
};

/// Multiplies what is painted by the light, with a dither against bands.
void shine(const RoomLight::Lattice& light, glm::vec2 half, float texelMetres,
           MipTexture::Level& level);

}  // namespace pleinair::hal::synthetic
