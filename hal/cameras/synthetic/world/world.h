#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hal/cameras/synthetic/world/builder.h"
#include "hal/cameras/synthetic/world/mip_texture.h"

namespace pleinair::hal::synthetic {

/// The workbench and the room around it; the same for every seed. Built once, on first use;
/// thread-safe.
const Geometry& workbenchGeometry();

/// A patch as it looks in the room's light. Column 0 is at the canvas's smallest x, row 0 at its
/// smallest y.
struct PatchTexture {
  MipTexture texture;
  float texelMetres = 0;
  glm::vec2 half{0};
};

/// What is to be seen of the workbench: a texture for each of the geometry's patches. Immutable.
struct World {
  const Geometry& geometry;
  std::vector<PatchTexture> textures;
};

/// Paints the workbench and lights it, on all processors; `texelMetres` is the bench top's, and
/// `seed` varies the wood.
World paintWorkbench(std::uint32_t seed, double texelMetres);

/// The same, painted once for all that look at it at a time. Thread-safe.
std::shared_ptr<const World> sharedWorkbench(std::uint32_t seed, double texelMetres);

}  // namespace pleinair::hal::synthetic
