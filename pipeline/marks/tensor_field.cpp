#include "pipeline/marks/tensor_field.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/program.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/marks/fading_past.h"
#include "pipeline/marks/layer_textures.h"

namespace pleinair::marks {
namespace {

const std::string kShaders = "pipeline/marks/shaders/";
constexpr int kRegionPixels = 8;
constexpr std::size_t kEdgeWords = 1 + 128;  // shaders/edge_bins.glsl
constexpr float kMoverSigma = 1.5F;          // regions; movers have no coarser levels
constexpr float kMinEdge = 0.05F;            // of luma: the level of sensor noise
constexpr GLbitfield kWritten = GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT;

glm::ivec2 itemsOf(const gpu::Texture& texture) {
  return {texture.size().width, texture.size().height};
}

gpu::Texture tensors(hal::FrameSize size) {
  return {gpu::TextureFormat::kRgba16f, size, gpu::TextureFilter::kLinear};
}

}  // namespace

struct TensorField::State {
  /// The textures of one level's region size.
  struct Level {
    explicit Level(hal::FrameSize size)
        : regions(tensors(size)), filled(tensors(size)), resolved(tensors(size)) {}
    gpu::Texture regions;
    gpu::Texture filled;
    gpu::Texture resolved;
  };
  /// The textures of one image size.
  struct Gradient {
    explicit Gradient(hal::FrameSize size)
        : texture(gpu::TextureFormat::kRg16f, size), target({&texture}) {}
    gpu::Texture texture;
    gpu::RenderTarget target;
  };

  State(const gpu::ShaderLibrary& library, hal::FrameSize fullSize)
      : full(fullSize),
        gradient(library.fragmentPass(kShaders + "gradient.frag")),
        histogram(library.compute(kShaders + "edge_histogram.comp")),
        threshold(library.compute(kShaders + "edge_threshold.comp")),
        regions(library.compute(kShaders + "tensor_regions.comp")),
        fill(library.compute(kShaders + "tensor_fill.comp")),
        reduce(library.compute(kShaders + "tensor_reduce.comp")),
        resolve(library.compute(kShaders + "tensor_resolve.comp")),
        edges(kEdgeWords * sizeof(std::uint32_t), gpu::BufferUsage::kDynamic),
        noIds(gpu::TextureFormat::kR32ui, {1, 1}) {
    edges.write(std::vector<std::byte>(edges.sizeBytes()));
    hal::FrameSize size{(full.width + kRegionPixels - 1) / kRegionPixels,
                        (full.height + kRegionPixels - 1) / kRegionPixels};
    before = tensors(size);
    moverRegions = tensors(size);
    moversBefore = tensors(size);
    movers = tensors(size);
    for (;;) {
      levels.emplace_back(size);
      if (size.width == 1 && size.height == 1) break;
      size = {(size.width + 1) / 2, (size.height + 1) / 2};
    }
  }

  hal::FrameSize full;
  gpu::Program gradient;
  gpu::Program histogram;
  gpu::Program threshold;
  gpu::Program regions;
  gpu::Program fill;
  gpu::Program reduce;
  gpu::Program resolve;
  gpu::Buffer edges;
  gpu::Texture noIds;
  LayerTextures layerTextures;
  std::vector<Level> levels;
  gpu::Texture before;
  gpu::Texture moverRegions;
  gpu::Texture moversBefore;
  gpu::Texture movers;  // filled
  std::vector<std::unique_ptr<Gradient>> gradients;
  hal::TimePoint lastTime;
  bool hasPast = false;

  const Gradient& gradientOf(hal::FrameSize size) {
    const auto known = std::ranges::find_if(
        gradients, [&](const auto& each) { return each->texture.size() == size; });
    if (known != gradients.end()) return **known;
    return *gradients.emplace_back(std::make_unique<Gradient>(size));
  }

  void findEdges(const scene::ArFrame& frame, const gpu::Texture& picture, double form,
                 float share);
  void sumRegions(const scene::ArFrame& frame, const MotionField& motion,
                  const MotionLayers* layers, bool goesOn, float past, float slack);
  void buildPyramid(const TensorFieldOptions& options);
};

void TensorField::State::findEdges(const scene::ArFrame& frame, const gpu::Texture& picture,
                                   double form, float share) {
  const Gradient& made = gradientOf(picture.size());
  gradient.use()
      .texture("picture", picture)
      .texture("ids", frame.hasObjects ? *frame.ids : noIds)
      .texture("normals", frame.hasObjects ? *frame.normalFocus : picture)
      .set("hasObjects", frame.hasObjects ? 1 : 0)
      .set("form", static_cast<float>(form))
      .drawFullscreen(made.target);
  histogram.use()
      .texture("tensors", made.texture)
      .storage("Edges", edges)
      .dispatch((itemsOf(made.texture) + 1) / 2, GL_SHADER_STORAGE_BARRIER_BIT);
  threshold.use()
      .storage("Edges", edges)
      .set("share", share)
      .set("least", kMinEdge)
      .dispatch({1, 1}, GL_SHADER_STORAGE_BARRIER_BIT);
}

void TensorField::State::sumRegions(const scene::ArFrame& frame, const MotionField& motion,
                                    const MotionLayers* layers, bool goesOn, float past,
                                    float slack) {
  Level& finest = levels.front();
  std::swap(finest.regions, before);
  std::swap(moverRegions, moversBefore);
  motion.bind(regions.use());
  regions.texture("tensors", gradientOf(frame.size()).texture)
      .texture("before", before)
      .texture("moversBefore", moversBefore)
      .texture("movers", layerTextures.labelsOf(layers))
      .texture("motion", motion.backward())
      .storage("Edges", edges)
      .image("regions", finest.regions, gpu::ImageAccess::kWrite)
      .image("moverRegions", moverRegions, gpu::ImageAccess::kWrite)
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .set("fullSize", glm::vec2(full.width, full.height))
      .set("regionPixels", static_cast<float>(kRegionPixels))
      .set("hasPast", goesOn ? 1 : 0)
      .set("past", past)
      .set("slack", slack)
      .dispatch(itemsOf(finest.regions), kWritten);
  fill.use()
      .texture("regions", moverRegions)
      .image("filled", movers, gpu::ImageAccess::kWrite)
      .set("sigma", kMoverSigma)
      .dispatch(itemsOf(movers), kWritten);
}

void TensorField::State::buildPyramid(const TensorFieldOptions& options) {
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (i > 0) {
      reduce.use()
          .texture("filled", levels[i - 1].filled)
          .image("reduced", levels[i].regions, gpu::ImageAccess::kWrite)
          .dispatch(itemsOf(levels[i].regions), kWritten);
    }
    fill.use()
        .texture("regions", levels[i].regions)
        .image("filled", levels[i].filled, gpu::ImageAccess::kWrite)
        .set("sigma", static_cast<float>(options.fillSigma))
        .dispatch(itemsOf(levels[i].filled), kWritten);
  }
  for (std::size_t i = levels.size(); i-- > 0;) {
    const bool isTop = i + 1 == levels.size();
    resolve.use()
        .texture("filled", levels[i].filled)
        .texture("above", isTop ? levels[i].filled : levels[i + 1].resolved)
        .set("isTop", isTop ? 1 : 0)
        .image("resolved", levels[i].resolved, gpu::ImageAccess::kWrite)
        .dispatch(itemsOf(levels[i].resolved), kWritten);
  }
}

TensorField::TensorField(const gpu::ShaderLibrary& library, hal::FrameSize full)
    : state_(std::make_unique<State>(library, full)) {}

TensorField::~TensorField() = default;

void TensorField::update(const scene::ArFrame& frame, const gpu::Texture& picture,
                         const MotionField& motion, const TensorFieldOptions& options,
                         const MotionLayers* layers) {
  State& s = *state_;
  assert(frame.full() == s.full && picture.size() == frame.size());
  assert(options.slack >= 0.0 && options.slack < 1.0);
  const hal::Duration step = timeStep(s.lastTime, frame.captureTime);
  const double memory = std::chrono::duration<double>(options.memory).count();
  const bool goesOn = s.hasPast && !motion.isCut();
  const double past = goesOn ? keptAfter(step, memory) : 0.0;
  s.lastTime = frame.captureTime;
  s.hasPast = true;
  s.findEdges(frame, picture, options.form, static_cast<float>(1.0 - past));
  s.sumRegions(frame, motion, layers, goesOn, static_cast<float>(past),
               static_cast<float>(options.slack));
  s.buildPyramid(options);
}

std::size_t TensorField::levelCount() const {
  return state_->levels.size();
}

const gpu::Texture& TensorField::resolved(std::size_t level) const {
  return state_->levels[level].resolved;
}

const gpu::Texture& TensorField::filled(std::size_t level) const {
  return state_->levels[level].filled;
}

const gpu::Texture& TensorField::regions() const {
  return state_->levels.front().regions;
}

const gpu::Texture& TensorField::movers() const {
  return state_->movers;
}

double TensorField::regionPixels(std::size_t level) const {
  return std::ldexp(kRegionPixels, static_cast<int>(level));
}

void TensorField::reset() {
  state_->hasPast = false;
}

}  // namespace pleinair::marks
