#pragma once

#include <cstddef>
#include <vector>

#include "hal/pixel_format.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/texture.h"

namespace pleinair::marks {

class SegmentMap;

/// The segments that directions do not spread across, and the side of a region, px of the full
/// image; without a map, they spread everywhere.
struct TensorSegments {
  const SegmentMap* map = nullptr;
  double regionPixels = 1.0;
};

/// Programs that extend tensors to regions without any, by a pyramid (thesis §4.2, steps 2 to 4).
/// All calls on the thread of the GL context that was current at construction.
class TensorPyramidMaker {
 public:
  /// `library` has gpu::marksShaders().
  explicit TensorPyramidMaker(const gpu::ShaderLibrary& library);

  /// Textures of all levels, RGBA16F: tensor, confidence, detail. Each level has half of the
  /// regions of the one before, to 1×1.
  struct Level {
    explicit Level(hal::FrameSize size);
    gpu::Texture regions;   ///< of the finest level: the input; else from the level before
    gpu::Texture filled;    ///< regions without a tensor have their neighbours'
    gpu::Texture resolved;  ///< and, if these have none either, that of coarser levels
  };
  /// Throws hal::Failure if GPU memory runs out.
  static std::vector<Level> levelsOf(hal::FrameSize finest);

  /// Fills a level: `sigma` is the width of the radial-basis interpolation, in regions.
  void fill(const gpu::Texture& regions, double sigma, const gpu::Texture& filled,
            const TensorSegments& segments = {});
  /// Makes all levels from the finest one's regions, whose side `segments` tells.
  void build(std::vector<Level>& levels, double sigma, const TensorSegments& segments = {});

 private:
  gpu::Program fill_;
  gpu::Program reduce_;
  gpu::Program resolve_;
  gpu::Texture noCells_;
};

}  // namespace pleinair::marks
