#include "pipeline/marks/movers/mover_motion.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "pipeline/gpu/render_target.h"
#include "pipeline/marks/movers/motion_layers.h"

namespace pleinair::marks {
namespace {

using gpu::ImageAccess;
using gpu::TextureFormat;

const std::string kShaders = "pipeline/marks/movers/shaders/";
constexpr std::size_t kRegistrations = 2;  // steps of shaders/mover_registration.comp
/// Weights of what is known before, in parts of what is seen: flow beside an outline falls short,
/// registration does not.
constexpr float kFlowDamping = 0.5F;
constexpr float kDamping = 0.01F;
constexpr float kMostMotionScale = 4.0F;
constexpr float kFadeSeconds = 0.3F;  // of a motion of which nothing is seen
constexpr GLbitfield kStored = GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                               GL_SHADER_STORAGE_BARRIER_BIT;

}  // namespace

/// How much a solution keeps of the motion before it: shaders/mover_motion.comp.
struct MoverMotion::Weights {
  float earlierScale = 1.0F;
  float fade = 1.0F;
  float damping = 0.0F;
};

MoverMotion::MoverMotion(const gpu::ShaderLibrary& library, hal::FrameSize blocks)
    : findEdges_(library.compute(kShaders + "mover_edges.comp")),
      findMotion_(library.compute(kShaders + "mover_motion.comp")),
      smoothMotion_(library.compute(kShaders + "mover_smooth.comp")),
      registerMovers_(library.compute(kShaders + "mover_registration.comp")) {
  // Those of all movers, one above the other.
  const hal::FrameSize size{blocks.width, MotionLayers::kMostMovers * blocks.height};
  for (std::size_t i = 0; i < 2; ++i) {
    motions_.at(i) = {TextureFormat::kRgba16f, size};
    const gpu::RenderTarget target({&motions_.at(i)});  // read before it is first written
    target.beginKeeping();
    target.clearColour(0, glm::vec4(0.0F));
    normals_.at(i) = {TextureFormat::kRgba16f, size};
    normalFlow_.at(i) = {TextureFormat::kRgba16f, size};
  }
}

void MoverMotion::update(const MoverFrames& frames, const BackgroundBinding& binding) {
  const scene::ArFrame& frame = *frames.frame;
  const MotionField& field = *frames.field;
  field.bindBackward(findEdges_.use());
  binding.bind(findEdges_, frame, field, frames.last);
  findEdges_.texture("moverShares", *frames.shares)
      .texture("picture", *frames.picture)
      .texture("moverMotion", motion())
      .set("motionScale", frames.motionScale)
      .image("normals", normals_.at(0), ImageAccess::kWrite)
      .image("normalFlow", normalFlow_.at(0), ImageAccess::kWrite);
  frames.blocks.dispatch(findEdges_, kStored, BlockCommand::kMotion);
  solve(frames, 0,
        {.earlierScale = std::min(frames.motionScale, kMostMotionScale),
         .fade = std::exp(-frames.stepSeconds / kFadeSeconds),
         .damping = kFlowDamping});
  for (std::size_t i = 0; i < kRegistrations && frames.hasPast; ++i) {
    const std::size_t from = i % 2;
    field.bind(registerMovers_.use());
    binding.bind(registerMovers_, frame, field, frames.last);
    registerMovers_.texture("moverShares", *frames.shares)
        .texture("lastShares", *frames.lastShares)
        .texture("picture", *frames.picture)
        .texture("lastPicture", *frames.lastPicture)
        .texture("moverMotion", motion())
        .set("noise", cellNoise(field))
        .set("arms", 4)
        .texture("edges", normals_.at(from))
        .texture("edgeFlow", normalFlow_.at(from))
        .image("normals", normals_.at(1 - from), ImageAccess::kWrite)
        .image("normalFlow", normalFlow_.at(1 - from), ImageAccess::kWrite);
    frames.blocks.dispatch(registerMovers_, kStored, BlockCommand::kMotion);
    solve(frames, 1 - from, {.damping = kDamping});
  }
  const gpu::Texture& found = motion();
  at_ = 1 - at_;
  smoothMotion_.use()
      .texture("found", found)
      .image("moverMotion", motions_.at(at_), ImageAccess::kWrite);
  frames.blocks.dispatch(smoothMotion_, kStored, BlockCommand::kMotion);
}

void MoverMotion::solve(const MoverFrames& frames, std::size_t which, const Weights& weights) {
  const gpu::Texture& earlier = motion();
  at_ = 1 - at_;
  frames.blocks.bind(findMotion_.use())
      .texture("earlier", earlier)
      .set("earlierScale", weights.earlierScale)
      .set("fade", weights.fade)
      .set("damping", weights.damping)
      .set("turn", frames.turn)
      .texture("normals", normals_.at(which))
      .texture("normalFlow", normalFlow_.at(which))
      .image("moverMotion", motions_.at(at_), ImageAccess::kWrite);
  frames.blocks.dispatch(findMotion_, kStored, BlockCommand::kMotion);
}

}  // namespace pleinair::marks
