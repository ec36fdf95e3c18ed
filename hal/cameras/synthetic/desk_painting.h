#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

#include "hal/cameras/synthetic/mip_texture.h"

namespace pleinair::hal::synthetic {

/// The desk's top: a rectangle in the plane z = 0.
inline constexpr glm::dvec2 kDeskLow{-0.92, -0.62};
inline constexpr glm::dvec2 kDeskHigh{0.92, 0.72};
inline constexpr double kDeskCornerRadius = 0.02;

/// The desk's painted top and where it lies.
struct DeskPicture {
  MipTexture texture;
  glm::dvec2 originMetres{0};  ///< outer corner of texel (0, 0); columns run along x, rows along y
  double texelMetres = 0;
};

/// Paints the desk with everything that lies on it and the light that falls on it. Takes about a
/// second at 0.6 mm a texel; `seed` varies the wood, not the layout.
DeskPicture paintDesk(std::uint32_t seed, double texelMetres);

}  // namespace pleinair::hal::synthetic
