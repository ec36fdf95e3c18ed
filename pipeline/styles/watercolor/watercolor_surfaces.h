#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/styles/watercolor/cell_tiling.h"

namespace pleinair::styles {

/// The colours of all cells, each in its anchor's slot. All levels of quality
/// have the same cells.
struct WatercolorCells {
  explicit WatercolorCells(std::uint32_t slotCount)
      : slots(slotCount),
        moments(std::size_t{slots} * 8 * sizeof(std::uint32_t), gpu::BufferUsage::kDynamic),
        averages{gpu::Buffer(averagesBytes(), gpu::BufferUsage::kDynamic),
                 gpu::Buffer(averagesBytes(), gpu::BufferUsage::kDynamic)},
        darkWash(gpu::TextureFormat::kRgba8, slotTextureSize(slots)),
        lightWash(gpu::TextureFormat::kRgba8, slotTextureSize(slots)),
        places(gpu::TextureFormat::kRgba32f, slotTextureSize(slots)),
        ways(gpu::TextureFormat::kRgba16f, slotTextureSize(slots)) {
    moments.write(std::vector<std::byte>(moments.sizeBytes()));
  }
  std::size_t averagesBytes() const { return std::size_t{slots} * 8 * sizeof(float); }

  std::uint32_t slots;
  gpu::Buffer moments;      ///< of a frame's pixels: shaders/split.comp
  gpu::Buffer averages[2];  ///< of them, over time, by turns: shaders/washes.comp
  int latest = 0;           ///< of the averages
  gpu::Texture darkWash;
  gpu::Texture lightWash;
  gpu::Texture places;  ///< for views: shaders/show_seeds.comp
  gpu::Texture ways;    ///< the same
};

/// The masks of what moves over the paper (shaders/gliding.frag), this frame's and the last one's by
/// turns. `size`: that of the motion field.
struct WatercolorGliding {
  explicit WatercolorGliding(hal::FrameSize size)
      : masks{{gpu::TextureFormat::kRgba8, size, gpu::TextureFilter::kLinear},
              {gpu::TextureFormat::kRgba8, size, gpu::TextureFilter::kLinear}},
        targets{gpu::RenderTarget({&masks[0]}), gpu::RenderTarget({&masks[1]})} {}
  const gpu::Texture& now() const { return masks[latest]; }

  gpu::Texture masks[2];
  gpu::RenderTarget targets[2];
  int latest = 0;
};

/// The textures of one image size. They hold one frame's pixels, and no history.
struct WatercolorCanvas {
  explicit WatercolorCanvas(hal::FrameSize pictureSize)
      : size(pictureSize),
        tiling(gpu::TextureFormat::kR32ui, size),
        guide(gpu::TextureFormat::kRgba8, reduced(2), gpu::TextureFilter::kLinear),
        darkPigment(gpu::TextureFormat::kRgba8, reduced(4), gpu::TextureFilter::kLinear),
        lightPigment(gpu::TextureFormat::kRgba8, reduced(4), gpu::TextureFilter::kLinear),
        darkLayer(gpu::TextureFormat::kRgba8, reduced(2), gpu::TextureFilter::kLinear),
        lightLayer(gpu::TextureFormat::kRgba8, reduced(2), gpu::TextureFilter::kLinear),
        picture(gpu::TextureFormat::kRgba8, size, gpu::TextureFilter::kLinear),
        guideTarget({&guide}),
        pigmentTarget({&darkPigment, &lightPigment}),
        layersTarget({&darkLayer, &lightLayer}),
        pictureTarget({&picture}) {}

  /// One pixel for `by` of the picture, at least one.
  hal::FrameSize reduced(int by) const {
    return {(size.width + by - 1) / by, (size.height + by - 1) / by};
  }

  hal::FrameSize size;
  gpu::Texture tiling;
  gpu::Texture guide;
  gpu::Texture darkPigment;
  gpu::Texture lightPigment;
  gpu::Texture darkLayer;
  gpu::Texture lightLayer;
  gpu::Texture picture;
  gpu::RenderTarget guideTarget;
  gpu::RenderTarget pigmentTarget;
  gpu::RenderTarget layersTarget;
  gpu::RenderTarget pictureTarget;
};

}  // namespace pleinair::styles
