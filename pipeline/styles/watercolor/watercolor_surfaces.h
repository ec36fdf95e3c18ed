#pragma once

#include <cstddef>
#include <cstdint>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/styles/watercolor/cell_grid.h"

namespace pleinair::styles {

/// What the watercolor has of each cell. All levels of quality have the same cells.
struct WatercolorCells {
  static constexpr std::size_t kSumWords = 8;  // a cell, in the shaders of sums and of moments

  WatercolorCells(hal::FrameSize fullSize, int cellSizePixels)
      : full(fullSize),
        cellSize(cellSizePixels),
        grid(fullSize, cellSizePixels),
        seeds(grid.count() * sizeof(glm::vec2), gpu::BufferUsage::kDynamic),
        sums(grid.count() * kSumWords * sizeof(std::uint32_t), gpu::BufferUsage::kDynamic),
        moments(grid.count() * kSumWords * sizeof(std::uint32_t), gpu::BufferUsage::kDynamic),
        means(gpu::TextureFormat::kRgba16f, grid.size()),
        shifts(gpu::TextureFormat::kRgba16f, grid.size()),
        darkWash(gpu::TextureFormat::kRgba8, grid.size()),
        lightWash(gpu::TextureFormat::kRgba8, grid.size()) {}

  hal::FrameSize full;  ///< of the full picture, and what the cell size is in px of
  int cellSize;
  CellGrid grid;
  gpu::Buffer seeds;  ///< in px of the picture that was painted last
  gpu::Buffer sums;
  gpu::Buffer moments;
  gpu::Texture means;
  gpu::Texture shifts;
  gpu::Texture darkWash;
  gpu::Texture lightWash;
};

/// What it has of the pixels of pictures of one size; nothing of the past.
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
