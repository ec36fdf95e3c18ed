#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "hal/clock.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/anchors/anchor_set.h"
#include "pipeline/marks/anchors/point_bins.h"
#include "pipeline/marks/movers/layer_textures.h"
#include "pipeline/scene/render/object_programs.h"
#include "pipeline/styles/watercolor/watercolor_parameters.h"

namespace pleinair::styles {

/// A cell's seed beside its anchor's slot (shaders/seed.glsl).
struct CellSeed {
  glm::vec2 offset{0.0F};    ///< from its anchor, px of the full picture
  float restless = 0.0F;     ///< how long it has had reason to move, s
  std::uint32_t state = 0;   ///< the flags below
  std::uint32_t parent = 0;  ///< the slot of the cell in which it was spawned, plus one
  std::uint32_t spare[3] = {};

  static constexpr std::uint32_t kMoving = 1;
  static constexpr std::uint32_t kBorn = 2;
  static constexpr std::uint32_t kLiving = 4;
  static constexpr std::uint32_t kHeld = 8;

  bool isMoving() const { return (state & kMoving) != 0; }
  bool isLiving() const { return (state & kLiving) != 0; }
};
static_assert(sizeof(CellSeed) == 32);

/// The inputs of a frame's tiling, and its output.
struct TilingFrame {
  const scene::ArFrame* frame = nullptr;
  const gpu::Texture* picture = nullptr;        ///< that edges and colours are taken from
  const marks::MotionLayers* movers = nullptr;  ///< null: movers are not told apart
  const gpu::Texture* tilingThen = nullptr;     ///< of the previous frame; null where there is none
  const gpu::Texture* tiling = nullptr;         ///< to be written: R32UI, shaders/tiling_word.glsl
  hal::Duration step{0};                        ///< since the previous frame
  bool wantsMeans = false;
};

/// The Voronoi cells of seeds that belong to anchors (thesis §3.2, and on): a seed is carried with
/// its anchor, drawn to the edges in its cell or to the cell's middle, and rests until it has
/// reason to move for a while. Cells whose anchors fade in or out grow and shrink (a power
/// diagram). Movers have cells of their own; those behind and beside them wait for them to pass.
/// All on the GPU. All calls on the thread of the GL context it was made in.
class CellTiling {
 public:
  /// `library` has gpu::watercolorShaders(), marksShaders(), sceneShaders().
  explicit CellTiling(const gpu::ShaderLibrary& library);

  /// Makes room for so many slots and forgets all seeds. Throws hal::Failure where the GPU has
  /// no memory for them.
  void allocate(hal::FrameSize full, int cellSizePixels, std::uint32_t slots);
  std::uint32_t slots() const { return slots_; }

  /// Tiles a frame; where the anchors have begun anew their seeds settle in a few rounds at once.
  void tile(const TilingFrame& input, const marks::AnchorSet& anchors,
            const WatercolorParameters& parameters);

  /// A CellSeed per slot, for the next frame.
  const gpu::Buffer& seeds() const { return seeds_; }
  /// A marks::BinnedPoint per slot: the seeds of the last tiling.
  const gpu::Buffer& points() const { return points_; }
  /// RGBA16F, a texel a slot (slotTextureSize): linear RGB; 0 in A where it has no pixel. Only
  /// after a frame that wanted means.
  const gpu::Texture& means() const { return means_; }

  /// How many seeds were on their way in the last frame. Waits for the GPU: for measures and tests.
  std::size_t readMoving() const;

 private:
  void placeSeeds(const TilingFrame& input, const marks::AnchorSet& anchors, bool carries);
  void findCells(const TilingFrame& input, const WatercolorParameters& p);
  void moveSeeds(const TilingFrame& input, const WatercolorParameters& p, bool atOnce);

  gpu::Program place_;
  scene::ObjectPrograms nearest_;
  gpu::Program move_;
  marks::PointBins bins_;
  marks::LayerTextures layerTextures_;
  gpu::Buffer moverGroups_;  ///< the command that tiles movers (shaders/seeds.comp)
  hal::FrameSize full_;
  int cellSize_ = 1;
  std::uint32_t slots_ = 0;
  gpu::Buffer seeds_;
  gpu::Buffer points_;
  gpu::Buffer sums_;
  gpu::Texture means_;
};

/// The size of textures with a texel for each slot (shaders/tiling_word.glsl).
hal::FrameSize slotTextureSize(std::uint32_t slots);

}  // namespace pleinair::styles
