#include "pipeline/marks/tensors/tensor_pyramid.h"

#include <cmath>
#include <string>

#include "pipeline/marks/tensors/segment_map.h"

namespace pleinair::marks {
namespace {

const std::string kShaders = "pipeline/marks/tensors/shaders/";
constexpr GLbitfield kWritten = GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT;

glm::ivec2 itemsOf(const gpu::Texture& texture) {
  return {texture.size().width, texture.size().height};
}

gpu::Texture tensors(hal::FrameSize size) {
  return {gpu::TextureFormat::kRgba16f, size, gpu::TextureFilter::kLinear};
}

}  // namespace

TensorPyramidMaker::TensorPyramidMaker(const gpu::ShaderLibrary& library)
    : fill_(library.compute(kShaders + "tensor_fill.comp")),
      reduce_(library.compute(kShaders + "tensor_reduce.comp")),
      resolve_(library.compute(kShaders + "tensor_resolve.comp")),
      noCells_(gpu::TextureFormat::kR32ui, {1, 1}) {}

TensorPyramidMaker::Level::Level(hal::FrameSize size)
    : regions(tensors(size)), filled(tensors(size)), resolved(tensors(size)) {}

std::vector<TensorPyramidMaker::Level> TensorPyramidMaker::levelsOf(hal::FrameSize finest) {
  std::vector<Level> levels;
  for (hal::FrameSize size = finest;;) {
    levels.emplace_back(size);
    if (size.width == 1 && size.height == 1) return levels;
    size = {(size.width + 1) / 2, (size.height + 1) / 2};
  }
}

void TensorPyramidMaker::fill(const gpu::Texture& regions, double sigma, const gpu::Texture& filled,
                              const TensorSegments& segments) {
  SegmentMap::bind(fill_.use(), segments.map, noCells_);
  fill_.texture("regions", regions)
      .image("filled", filled, gpu::ImageAccess::kWrite)
      .set("sigma", static_cast<float>(sigma))
      .set("regionPixels", static_cast<float>(segments.regionPixels))
      .dispatch(itemsOf(filled), kWritten);
}

void TensorPyramidMaker::build(std::vector<Level>& levels, double sigma,
                               const TensorSegments& segments) {
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (i > 0) {
      reduce_.use()
          .texture("filled", levels[i - 1].filled)
          .image("reduced", levels[i].regions, gpu::ImageAccess::kWrite)
          .dispatch(itemsOf(levels[i].regions), kWritten);
    }
    fill(levels[i].regions, sigma, levels[i].filled,
         {segments.map, std::ldexp(segments.regionPixels, static_cast<int>(i))});
  }
  for (std::size_t i = levels.size(); i-- > 0;) {
    const bool isTop = i + 1 == levels.size();
    resolve_.use()
        .texture("filled", levels[i].filled)
        .texture("above", isTop ? levels[i].filled : levels[i + 1].resolved)
        .set("isTop", isTop ? 1 : 0)
        .image("resolved", levels[i].resolved, gpu::ImageAccess::kWrite)
        .dispatch(itemsOf(levels[i].resolved), kWritten);
  }
}

}  // namespace pleinair::marks
