#include "pipeline/marks/filtered_frame.h"

#include <algorithm>
#include <cassert>
#include <string>

#include "pipeline/gpu/images/pixel_block.h"
#include "pipeline/marks/fading_past.h"

namespace pleinair::marks {
namespace {

using gpu::ImageAccess;
using gpu::TextureFilter;
using gpu::TextureFormat;

const std::string kShaders = "pipeline/marks/shaders/";

}  // namespace

FilteredFrame::Canvas::Canvas(hal::FrameSize pictureSize)
    : size(pictureSize),
      pictures{gpu::Texture(TextureFormat::kRgba16f, size, TextureFilter::kLinear),
               gpu::Texture(TextureFormat::kRgba16f, size, TextureFilter::kLinear)} {}

FilteredFrame::FilteredFrame(const gpu::ShaderLibrary& library)
    : average_(library.compute(kShaders + "filtered_frame.comp")),
      averageObjects_(library.compute(kShaders + "filtered_frame_objects.comp")),
      noMotion_(TextureFormat::kRgba16f, {1, 1}) {}

FilteredFrame::Canvas& FilteredFrame::canvasOf(hal::FrameSize size) {
  const auto known =
      std::ranges::find_if(canvases_, [&](const auto& c) { return c->size == size; });
  if (known != canvases_.end()) return **known;
  return *canvases_.emplace_back(std::make_unique<Canvas>(size));
}

void FilteredFrame::update(const scene::ArFrame& frame, const FilteredFrameInput& input) {
  assert(input.backward != nullptr);
  if (full_ != frame.full()) {
    reset();
    now_ = nullptr;
    canvases_.clear();
    full_ = frame.full();
  }
  Canvas& canvas = canvasOf(frame.size());
  const int writes = now_ == &canvas.pictures[0] ? 1 : 0;
  const gpu::Texture& past = canvas.pictures[1 - writes];
  const bool hasPast = hasPast_ && now_ == &past && !input.isCut && input.timeConstantSeconds > 0.0;
  const bool hasMotion = frame.motion.has_value();
  const float kept =
      hasPast ? keptAfter(frame.captureTime - lastTime_, input.timeConstantSeconds) : 0.0F;
  const auto begin = [&](gpu::Program& program) -> gpu::Program& {
    return program.use()
        .image("filtered", canvas.pictures[writes], ImageAccess::kWrite)
        .texture("picture", *frame.colour)
        .texture("past", past)
        .set("kept", kept)
        .set("noise", static_cast<float>(input.noiseLevels / 255.0));
  };
  constexpr GLbitfield kStored = GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT;
  const glm::ivec2 blocks = gpu::pixelBlocksOf(canvas.size);
  begin(average_)
      .texture("backward", *input.backward)
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .dispatch(blocks, kStored);
  if (frame.hasObjects) {
    begin(averageObjects_)
        .texture("motion", hasMotion ? *frame.motion->texture : noMotion_)
        .texture("ids", *frame.ids)
        .set("hasMotion", hasMotion ? 1 : 0)
        .dispatch(blocks, kStored);
  }
  now_ = &canvas.pictures[writes];
  lastTime_ = frame.captureTime;
  hasPast_ = true;
}

void FilteredFrame::reset() {
  hasPast_ = false;
}

}  // namespace pleinair::marks
