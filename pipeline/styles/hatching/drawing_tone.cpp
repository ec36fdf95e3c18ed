#include "pipeline/styles/hatching/drawing_tone.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "pipeline/marks/fading_past.h"

namespace pleinair::styles {
namespace {

using gpu::TextureFilter;
using gpu::TextureFormat;

const std::string kToneShaders = "pipeline/styles/hatching/shaders/";

/// A picture whose mean luma is less is lightened, so that a place of that mean has it.
constexpr float kLeastMean = 0.33F;
/// The slope of the curve at black, and so what becomes of noise there, is 1 more.
constexpr float kMostLightening = 2.5F;
constexpr double kLighteningSeconds = 1.5;  // time constant
constexpr std::size_t kUniformBytes = 16;   // of a block of one number

hal::FrameSize halfOf(hal::FrameSize size) {
  return {std::max(1, size.width / 2), std::max(1, size.height / 2)};
}

}  // namespace

DrawingTone::Images::Images(hal::FrameSize size)
    : luma(TextureFormat::kR8, size, TextureFilter::kLinear),
      halfTone(TextureFormat::kRgba16f, halfOf(size), TextureFilter::kLinear),
      tone(TextureFormat::kRgba16f, halfOf(halfOf(size)), TextureFilter::kLinear),
      lumaTarget({&luma}),
      halfToneTarget({&halfTone}),
      toneTarget({&tone}) {}

DrawingTone::DrawingTone(const gpu::ShaderLibrary& library)
    : luma_(library.fragmentPass(kToneShaders + "luma.frag", {}, {TextureFormat::kR8})),
      first_(library.fragmentPass(kToneShaders + "tone.frag", {}, {TextureFormat::kRgba16f})),
      findLightening_(library.compute(kToneShaders + "tone_lightening.comp")),
      blur_(library.fragmentPass(kToneShaders + "tone_blur.frag", {}, {TextureFormat::kRgba16f})),
      noIds_(TextureFormat::kR32ui, {1, 1}),
      lightening_(kUniformBytes, gpu::BufferUsage::kDynamic) {
  lightening_.write(std::vector<std::byte>(kUniformBytes));
}

void DrawingTone::update(const scene::ArFrame& frame, const Inputs& inputs) {
  now_ = &images_.of(frame.size(), frame.size());
  luma_.use().texture("picture", *inputs.source).drawFullscreen(now_->lumaTarget);
  first_.use()
      .texture("lumas", now_->luma)
      .texture("ids", frame.hasObjects ? *frame.ids : noIds_)
      .texture("movers", layerTextures_.labelsOf(inputs.movers))
      .texture("background", layerTextures_.backgroundOf(inputs.movers))
      .set("hasObjects", frame.hasObjects ? 1 : 0)
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .drawFullscreen(now_->halfToneTarget);
  if (inputs.lighten > 0.0) findLightening(frame, inputs.isCut);
  const hal::FrameSize size = now_->tone.size();
  blur_.use()
      .texture("halfTone", now_->halfTone)
      .uniformBlock("ToneLightening", lightening_, 0, lightening_.sizeBytes())
      .set("lighten", static_cast<float>(inputs.lighten))
      .set("size", glm::vec2(size.width, size.height))
      .drawFullscreen(now_->toneTarget);
}

void DrawingTone::findLightening(const scene::ArFrame& frame, bool isCut) {
  const hal::Duration step = marks::timeStep(lastTime_, frame.captureTime);
  lastTime_ = frame.captureTime;
  findLightening_.use()
      .texture("halfTone", now_->halfTone)
      .storage("ToneLightening", lightening_)
      .set("least", kLeastMean)
      .set("most", kMostLightening)
      .set("share", isCut ? 1.0F : 1.0F - marks::keptAfter(step, kLighteningSeconds))
      .dispatch({1, 1}, GL_UNIFORM_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

void DrawingTone::clear() {
  now_ = nullptr;
  images_.clear();
}

}  // namespace pleinair::styles
