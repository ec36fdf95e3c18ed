#include "pipeline/styles/painterly/reduced_images.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

namespace pleinair::styles {
namespace {

const std::string kShaders = "pipeline/styles/painterly/shaders/";

}  // namespace

ReducedImages::Pyramid::Pyramid(hal::FrameSize size, gpu::TextureFormat format) {
  for (std::size_t i = 0; i < kHalvings; ++i) {
    size = {std::max(1, size.width / 2), std::max(1, size.height / 2)};
    levels[i] = gpu::Texture(format, size, gpu::TextureFilter::kLinear);
    targets[i] = gpu::RenderTarget({&levels[i]});
  }
}

ReducedImages::Apart::Apart(hal::FrameSize size, bool mayHaveModels)
    : background(size, gpu::TextureFormat::kRgba16f), movers(size, gpu::TextureFormat::kRgba16f) {
  if (mayHaveModels) {
    models.emplace(size, gpu::TextureFormat::kRgba16f);
    first = gpu::RenderTarget({&background.levels[0], &movers.levels[0], &models->levels[0]});
  } else {
    first = gpu::RenderTarget({&background.levels[0], &movers.levels[0]});
  }
}

ReducedImages::Surfaces::Surfaces(hal::FrameSize pictureSize)
    : size(pictureSize), whole(size, gpu::TextureFormat::kRgba8) {}

ReducedImages::ReducedImages(const gpu::ShaderLibrary& library)
    : halve_(library.fragmentPass(kShaders + "halve.frag", {}, {gpu::TextureFormat::kRgba8})),
      halveApart_(
          library.fragmentPass(kShaders + "halve.frag", {}, {gpu::TextureFormat::kRgba16f})),
      part_(library.fragmentPass(kShaders + "part.frag", {},
                                 {gpu::TextureFormat::kRgba16f, gpu::TextureFormat::kRgba16f})),
      partWithModels_(
          library.fragmentPass(kShaders + "part.frag", {{"MODELS"}},
                               {gpu::TextureFormat::kRgba16f, gpu::TextureFormat::kRgba16f,
                                gpu::TextureFormat::kRgba16f})),
      noIds_(gpu::TextureFormat::kR32ui, {1, 1}) {}

void ReducedImages::update(const scene::ArFrame& frame, const marks::MotionLayers* layers) {
  Surfaces& surfaces = surfaces_.of(frame.size(), frame.size());
  now_ = &surfaces;
  picture_ = frame.colour;
  hasObjects_ = frame.hasObjects;
  pixelsOfFull_ = frame.pixelsOfFull().x;
  hasMovers_ = layers != nullptr;
  isApart_ = frame.hasObjects || hasMovers_;
  const hal::FrameSize half = surfaces.whole.levels[0].size();
  halve_.use()
      .texture("picture", *frame.colour)
      .set("size", glm::vec2(half.width, half.height))
      .drawFullscreen(surfaces.whole.targets[0]);
  halve(halve_, surfaces.whole);
  if (!isApart_) return;
  const bool mayHaveModels = frame.mayHaveObjects();
  if (!surfaces.apart || (mayHaveModels && !surfaces.apart->models)) {
    surfaces.apart.emplace(frame.size(), mayHaveModels);
  }
  const bool hasModels = surfaces.apart->models.has_value();
  gpu::Program& part = hasModels ? partWithModels_ : part_;
  part.use()
      .texture("picture", *frame.colour)
      .texture("movers", layerTextures_.labelsOf(layers))
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()));
  if (hasModels) {
    part.texture("ids", frame.hasObjects ? *frame.ids : noIds_)
        .set("hasObjects", frame.hasObjects ? 1 : 0);
  }
  part.drawFullscreen(surfaces.apart->first);
  halve(halveApart_, surfaces.apart->background);
  if (frame.hasObjects) halve(halveApart_, *surfaces.apart->models);
  if (hasMovers_) halve(halveApart_, surfaces.apart->movers);
}

void ReducedImages::halve(gpu::Program& halving, const Pyramid& pyramid) {
  for (std::size_t i = 1; i < kHalvings; ++i) {
    const hal::FrameSize size = pyramid.levels[i].size();
    halving.use()
        .texture("picture", pyramid.levels[i - 1])
        .set("size", glm::vec2(size.width, size.height))
        .drawFullscreen(pyramid.targets[i]);
  }
}

std::optional<std::size_t> ReducedImages::levelOf(double px) {
  const auto halvings = static_cast<int>(std::floor(std::log2(px)));
  if (halvings < 1) return std::nullopt;
  return std::min(static_cast<std::size_t>(halvings), kHalvings) - 1;
}

float ReducedImages::texelPx(std::size_t halvings) const {
  return static_cast<float>(std::ldexp(1.0 / pixelsOfFull_, static_cast<int>(halvings)));
}

marks::StrokePaint ReducedImages::wholePaintOf(double px) const {
  assert(now_ != nullptr);
  const std::optional<std::size_t> level = levelOf(px);
  const gpu::Texture* const all = level ? &now_->whole.levels[*level] : picture_;
  return {.background = all,
          .models = all,
          .movers = all,
          .fineModels = all,
          .fineBackground = level ? now_->whole.levels.data() : picture_,
          .modelTexelPx = texelPx(level ? *level + 1 : 0)};
}

marks::StrokePaint ReducedImages::paintOf(double px) const {
  assert(now_ != nullptr);
  const std::optional<std::size_t> level = levelOf(px);
  // The picture itself knows nothing of parts; its pixels are fine enough.
  if (!isApart_ || !level) return wholePaintOf(px);
  const Apart& apart = *now_->apart;
  const gpu::Texture* const background = &apart.background.levels[*level];
  return {.background = background,
          .models = hasObjects_ ? &apart.models->levels[*level] : background,
          .movers = hasMovers_ ? &apart.movers.levels[*level] : background,
          .fineModels = hasObjects_ ? apart.models->levels.data() : background,
          .fineBackground = apart.background.levels.data(),
          .modelTexelPx = texelPx(*level + 1)};
}

const gpu::Texture& ReducedImages::whole(std::size_t halvings) const {
  assert(now_ != nullptr && halvings >= 1 && halvings <= kHalvings);
  return now_->whole.levels[halvings - 1];
}

void ReducedImages::clear() {
  now_ = nullptr;
  surfaces_.clear();
}

}  // namespace pleinair::styles
