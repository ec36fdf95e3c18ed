#include "pipeline/marks/movers/in_place_movers.h"

#include <algorithm>
#include <string>

namespace pleinair::marks {
namespace {

using gpu::ImageAccess;

const std::string kShaders = "pipeline/marks/movers/shaders/";
/// Of the image's longer side: 1.5 px of 640.
constexpr float kLeastDisplacement = 1.5F / 640.0F;
constexpr GLbitfield kStored = GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                               GL_SHADER_STORAGE_BARRIER_BIT;

gpu::Texture displacementOf(hal::FrameSize blocks) {
  return {gpu::TextureFormat::kRgba16f, blocks, gpu::TextureFilter::kLinear};
}

}  // namespace

InPlaceMovers::InPlaceMovers(const gpu::ShaderLibrary& library, hal::FrameSize blocks)
    : follow_(library.compute(kShaders + "mover_displacement.comp")),
      find_(library.compute(kShaders + "mover_in_place.comp")),
      displacements_{displacementOf(blocks), displacementOf(blocks)} {}

void InPlaceMovers::follow(const MotionField& field, hal::FrameSize full,
                           const gpu::Texture& candidates, const gpu::Texture& activity,
                           const BusyBlocks& blocks, bool stands, float stepSeconds) {
  const gpu::Texture& earlier = displacements_.at(now_);
  now_ = 1 - now_;
  blocks.bind(follow_.use())
      .texture("motion", field.backward())
      .texture("earlier", earlier)
      .texture("candidates", candidates)
      .texture("backgroundActivity", activity)
      .set("isStanding", stands ? 1 : 0)
      .set("leastDisplacement",
           kLeastDisplacement * static_cast<float>(std::max(full.width, full.height)))
      .set("stepSeconds", stepSeconds)
      .image("displacement", displacements_.at(now_), ImageAccess::kWrite)
      .dispatch(blocks.grid, kStored);
}

void InPlaceMovers::find(const gpu::Texture& candidates, const BusyBlocks& blocks,
                         const gpu::Texture& inPlace) {
  find_.use()
      .texture("displacements", displacements_.at(now_))
      .texture("candidates", candidates)
      .image("inPlace", inPlace, ImageAccess::kWrite);
  blocks.dispatch(find_, kStored);
}

}  // namespace pleinair::marks
