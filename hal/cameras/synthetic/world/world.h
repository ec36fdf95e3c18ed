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

struct WorldOptions {
  std::uint32_t seed = 1;      ///< varies the wood
  double texelMetres = 0.001;  ///< the texel size of the bench's top
  bool hasFigures = false;     ///< else their textures are left black
  bool hasSpotlight = false;   ///< switched on, beside the room's other light
};

/// Paints and lights the workbench, on all processors.
World paintWorkbench(const WorldOptions& options);

/// The same, painted once for all users of that world at a time. Thread-safe.
std::shared_ptr<const World> sharedWorkbench(const WorldOptions& options);

}  // namespace pleinair::hal::synthetic
