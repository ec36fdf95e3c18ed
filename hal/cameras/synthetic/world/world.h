#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hal/cameras/synthetic/world/builder.h"
#include "hal/cameras/synthetic/world/mip_texture.h"

namespace pleinair::hal::synthetic {

/// The geometry of the workbench and its room; the same for every seed. Built on first use;
/// thread-safe.
const Geometry& workbenchGeometry();

/// A patch's texture, lit by the room's light. Column 0 is at the canvas's smallest x, row 0 at its
/// smallest y.
struct PatchTexture {
  MipTexture texture;
  float texelMetres = 0;
  glm::vec2 half{0};
};

/// The lit workbench: one texture for each patch of the geometry. Immutable.
struct World {
  const Geometry& geometry;
  std::vector<PatchTexture> textures;
};

/// Paints and lights the workbench, on all processors. `texelMetres` is the texel size of the
/// bench's top; `seed` varies the wood.
World paintWorkbench(std::uint32_t seed, double texelMetres);

/// The same, painted once for all users of that world at a time. Thread-safe.
std::shared_ptr<const World> sharedWorkbench(std::uint32_t seed, double texelMetres);

}  // namespace pleinair::hal::synthetic
