#include "pipeline/marks/movers/in_place_movers.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace pleinair::marks {
namespace {

using gpu::ImageAccess;

const std::string kShaders = "pipeline/marks/movers/shaders/";
/// The width for which lengths are given.
constexpr float kSide = 640.0F;
constexpr float kLeastDisplacementPx = 1.5F;
constexpr float kMostErrorPx = 0.5F;
constexpr float kFarReachBlocks = 5.0F;
constexpr GLbitfield kStored = GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                               GL_SHADER_STORAGE_BARRIER_BIT;

gpu::Texture displacementOf(hal::FrameSize blocks) {
  return {gpu::TextureFormat::kRgba16f, blocks};
}

/// By which lengths grow with the image.
float scaleOf(const scene::ArFrame& frame) {
  return static_cast<float>(std::max(frame.full().width, frame.full().height)) / kSide;
}

}  // namespace

InPlaceMovers::InPlaceMovers(const gpu::ShaderLibrary& library, hal::FrameSize blocks)
    : follow_(library.compute(kShaders + "mover_displacement.comp")),
      find_(library.compute(kShaders + "mover_in_place.comp")),
      noIds_(gpu::TextureFormat::kR32ui, {1, 1}),
      displacements_{displacementOf(blocks), displacementOf(blocks)} {}

void InPlaceMovers::follow(const scene::ArFrame& frame, const MotionField& field,
                           const gpu::Texture& candidates, const gpu::Texture& activity,
                           const BusyBlocks& blocks, Camera camera, float stepSeconds) {
  const gpu::Texture& earlier = displacements_.at(now_);
  now_ = 1 - now_;
  const float scale = scaleOf(frame);
  blocks.bind(follow_.use())
      .texture("motion", field.backward())
      .texture("earlier", earlier)
      .texture("candidates", candidates)
      .texture("backgroundActivity", activity)
      .texture("ids", frame.hasObjects ? *frame.ids : noIds_)
      .set("hasObjects", frame.hasObjects ? 1 : 0)
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .set("isStanding", camera.stands ? 1 : 0)
      .set("isHeld", camera.hasStood ? 1 : 0)
      .set("leastDisplacement", scale * kLeastDisplacementPx)
      .set("mostError", std::max(scale, 1.0F) * kMostErrorPx)
      .set("stepSeconds", stepSeconds)
      .image("displacement", displacements_.at(now_), ImageAccess::kWrite)
      .dispatch(blocks.grid, kStored);
}

void InPlaceMovers::find(const scene::ArFrame& frame, const gpu::Texture& candidates,
                         const BusyBlocks& blocks, const gpu::Texture& inPlace) {
  find_.use()
      .texture("displacements", displacements_.at(now_))
      .texture("candidates", candidates)
      .set("farReach",
           static_cast<int>(std::lround(std::max(scaleOf(frame), 1.0F) * kFarReachBlocks)))
      .image("inPlace", inPlace, ImageAccess::kWrite);
  blocks.dispatch(find_, kStored);
}

}  // namespace pleinair::marks
