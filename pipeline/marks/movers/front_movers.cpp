#include "pipeline/marks/movers/front_movers.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <span>

#include <glm/vec4.hpp>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/render_target.h"

namespace pleinair::marks {
namespace {

using gpu::ImageAccess;
using gpu::TextureFilter;
using gpu::TextureFormat;

/// As in shaders/front_movers.comp.
struct GpuFootprints {
  std::array<glm::vec4, 2 * scene::kMaxFootprints> corners{};
};

constexpr GLbitfield kStored = GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT;
constexpr std::array<GLuint, 4> kHidesNothing{3, 0, 0, 0};  // as shaders/draw_command.glsl

}  // namespace

struct FrontMovers::State {
  State(const gpu::ShaderLibrary& library, hal::FrameSize size)
      : find(library.compute("pipeline/marks/movers/shaders/front_movers.comp")),
        show(library.compute("pipeline/marks/movers/shaders/front_labels.comp")),
        labels(TextureFormat::kRgba16f, size, TextureFilter::kLinear),
        shares(TextureFormat::kRgba8, size, TextureFilter::kLinear),
        footprints(sizeof(GpuFootprints), gpu::BufferUsage::kDynamic),
        hiding(gpu::kDrawCommandBytes, gpu::BufferUsage::kDynamic) {
    seen = gpu::RenderTarget({&labels, &shares});
    for (std::size_t i = 0; i < 2; ++i) {
      fronts.at(i) = {TextureFormat::kRgba16f, size, TextureFilter::kLinear};
      targets.at(i) = gpu::RenderTarget({&fronts.at(i)});
    }
  }
  void write(const scene::ArFrame& frame);
  void spread(const scene::ArFrame& frame, const gpu::Texture& moverLabels,
              const BusyBlocks& blocks, bool grants, float passed);

  gpu::Program find;
  gpu::Program show;
  std::array<gpu::Texture, 2> fronts;
  std::array<gpu::RenderTarget, 2> targets;  // of fronts
  gpu::Texture labels;
  gpu::Texture shares;
  gpu::RenderTarget seen;  // both of them
  gpu::Buffer footprints;
  gpu::Buffer hiding;  // the command that hides models: drawn where front_movers.comp says so
  GpuFootprints staged;
  std::size_t now = 0;
  bool hasPast = false;
};

/// Px of the full image.
void FrontMovers::State::write(const scene::ArFrame& frame) {
  const glm::vec2 scale(1.0 / frame.pixelsOfFull());
  const auto packed = [&](glm::vec2 a, glm::vec2 b) { return glm::vec4(a * scale, b * scale); };
  for (std::size_t i = 0; i < frame.footprints.size(); ++i) {
    const auto& px = frame.footprints[i].px;
    staged.corners.at(2 * i) = packed(px[0], px[1]);
    staged.corners.at(2 * i + 1) = packed(px[2], px[3]);
  }
  footprints.write(std::as_bytes(std::span(&staged, 1)));
}

void FrontMovers::State::spread(const scene::ArFrame& frame, const gpu::Texture& moverLabels,
                                const BusyBlocks& blocks, bool grants, float passed) {
  const std::size_t before = now;
  now = 1 - now;
  // No mover, but where it is found.
  glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT);  // written as an image before
  targets.at(now).beginDiscarding();
  targets.at(now).clearColour(0, glm::vec4(0.0F));
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);  // stores come after the clear
  find.use()
      .texture("labels", moverLabels)
      .texture("before", fronts.at(before))
      .texture("ids", *frame.ids)
      .uniformBlock("Footprints", footprints, 0, sizeof(GpuFootprints))
      .set("footprintCount", grants ? static_cast<int>(frame.footprints.size()) : 0)
      .set("hasPast", hasPast ? 1 : 0)
      .set("passed", passed)
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .storage("Hiding", hiding)
      .image("front", fronts.at(now), ImageAccess::kWrite);
  blocks.dispatch(find, kStored | GL_COMMAND_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  hasPast = true;
}

FrontMovers::FrontMovers(const gpu::ShaderLibrary& library, hal::FrameSize cells)
    : state_(std::make_unique<State>(library, cells)) {}

FrontMovers::~FrontMovers() = default;

void FrontMovers::update(const scene::ArFrame& frame, const gpu::Texture& moverLabels,
                         const gpu::Texture& moverShares, const BusyBlocks& blocks, bool isStanding,
                         float stepSeconds) {
  State& s = *state_;
  assert(frame.hasObjects && moverLabels.size() == s.labels.size());
  s.write(frame);
  s.hiding.write(std::as_bytes(std::span(kHidesNothing)));
  s.spread(frame, moverLabels, blocks, isStanding, stepSeconds / kStaysSeconds);
  // Again, so that a fast mover is found as a whole within a few frames.
  s.spread(frame, moverLabels, blocks, false, 0.0F);
  // spread() has waited for what wrote these as images before.
  s.seen.beginDiscarding();
  for (const int each : {0, 1}) s.seen.clearColour(each, glm::vec4(0.0F));
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);  // stores come after the clear
  s.show.use()
      .texture("labels", moverLabels)
      .texture("shares", moverShares)
      .texture("front", s.fronts.at(s.now))
      .texture("ids", *frame.ids)
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .image("seenLabels", s.labels, ImageAccess::kWrite)
      .image("seenShares", s.shares, ImageAccess::kWrite);
  blocks.dispatch(s.show, kStored);
}

void FrontMovers::reset() {
  state_->hasPast = false;
}

const gpu::Texture& FrontMovers::front() const {
  return state_->fronts.at(state_->now);
}

scene::ModelCover FrontMovers::cover() const {
  return {.places = &front(), .command = &state_->hiding};
}

const gpu::Texture& FrontMovers::seenLabels() const {
  return state_->labels;
}

const gpu::Texture& FrontMovers::seenShares() const {
  return state_->shares;
}

}  // namespace pleinair::marks
