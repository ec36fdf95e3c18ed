#include "pipeline/marks/tensors/tensor_field.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/marks/fading_past.h"
#include "pipeline/marks/movers/layer_textures.h"
#include "pipeline/marks/tensors/tensor_pyramid.h"
#include "pipeline/scene/render/object_programs.h"

namespace pleinair::marks {
namespace {

const std::string kShaders = "pipeline/marks/tensors/shaders/";
constexpr int kRegionPixels = 8;
constexpr std::size_t kEdgeWords = 2 + 128;  // shaders/edge_bins.glsl
constexpr double kMoverSigma = 1.5;          // regions; movers have no coarser levels
constexpr float kMinEdge = 0.05F;            // P: the level of sensor noise
constexpr GLbitfield kWritten = GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT;

glm::ivec2 itemsOf(const gpu::Texture& texture) {
  return {texture.size().width, texture.size().height};
}

gpu::Texture tensors(hal::FrameSize size) {
  return {gpu::TextureFormat::kRgba16f, size, gpu::TextureFilter::kLinear};
}

}  // namespace

struct TensorField::State {
  /// The textures of one image size.
  struct Gradient {
    explicit Gradient(hal::FrameSize size)
        : texture(gpu::TextureFormat::kRg16f, size), target({&texture}) {}
    gpu::Texture texture;
    gpu::RenderTarget target;
  };

  State(const gpu::ShaderLibrary& library, hal::FrameSize fullSize)
      : full(fullSize),
        gradient([&library](const gpu::ShaderDefines& defines) {
          return library.fragmentPass(kShaders + "gradient.frag", defines,
                                      {gpu::TextureFormat::kRg16f});
        }),
        histogram([&library](const gpu::ShaderDefines& defines) {
          return library.compute(kShaders + "edge_histogram.comp", defines);
        }),
        threshold(library.compute(kShaders + "edge_threshold.comp")),
        regions([&library](const gpu::ShaderDefines& defines) {
          return library.compute(kShaders + "tensor_regions.comp", defines);
        }),
        modelRegions(library.compute(kShaders + "tensor_models.comp")),
        pyramid(library),
        edges(kEdgeWords * sizeof(std::uint32_t), gpu::BufferUsage::kDynamic),
        noIds(gpu::TextureFormat::kR32ui, {1, 1}) {
    edges.write(std::vector<std::byte>(edges.sizeBytes()));
    const hal::FrameSize size{(full.width + kRegionPixels - 1) / kRegionPixels,
                              (full.height + kRegionPixels - 1) / kRegionPixels};
    before = tensors(size);
    moverRegions = tensors(size);
    moversBefore = tensors(size);
    movers = tensors(size);
    background = TensorPyramidMaker::levelsOf(size);
  }

  hal::FrameSize full;
  scene::ObjectPrograms gradient;
  scene::ObjectPrograms histogram;
  gpu::Program threshold;
  scene::ObjectPrograms regions;
  gpu::Program modelRegions;
  TensorPyramidMaker pyramid;
  gpu::Buffer edges;
  gpu::Texture noIds;
  LayerTextures layerTextures;
  /// Tensors of virtual objects; made when the first one is seen.
  struct Models {
    explicit Models(hal::FrameSize size)
        : levels(TensorPyramidMaker::levelsOf(size)),
          before(tensors(size)),
          labels(gpu::TextureFormat::kR32ui, size),
          labelsBefore(gpu::TextureFormat::kR32ui, size) {}
    std::vector<TensorPyramidMaker::Level> levels;
    gpu::Texture before;
    gpu::Texture labels;  // of each region
    gpu::Texture labelsBefore;
    bool hasPast = false;
    bool hasPatchesBefore = false;
  };

  std::vector<TensorPyramidMaker::Level> background;
  gpu::Texture before;
  gpu::Texture moverRegions;
  gpu::Texture moversBefore;
  gpu::Texture movers;  // filled
  std::optional<Models> models;
  std::vector<std::unique_ptr<Gradient>> gradients;
  hal::TimePoint lastTime;
  bool hasPast = false;

  const Gradient& gradientOf(hal::FrameSize size) {
    const auto known = std::ranges::find_if(
        gradients, [&](const auto& each) { return each->texture.size() == size; });
    if (known != gradients.end()) return **known;
    return *gradients.emplace_back(std::make_unique<Gradient>(size));
  }

  /// The past of the field, and how much of it remains.
  struct Past {
    bool isThere = false;
    float share = 0.0F;
    float slack = 0.0F;
  };
  void findEdges(const scene::ArFrame& frame, const gpu::Texture& picture,
                 const MotionLayers* layers, float share, float maxLeading);
  void sumRegions(const scene::ArFrame& frame, const MotionField& motion,
                  const MotionLayers* layers, const Past& past);
  void sumModels(const scene::ArFrame& frame, double form, const Past& past);
};

void TensorField::State::findEdges(const scene::ArFrame& frame, const gpu::Texture& picture,
                                   const MotionLayers* layers, float share, float maxLeading) {
  const Gradient& made = gradientOf(picture.size());
  gradient.use(frame)
      .texture("picture", picture)
      .texture("ids", frame.hasObjects ? *frame.ids : noIds)
      .drawFullscreen(made.target);
  histogram.use(frame)
      .texture("tensors", made.texture)
      .texture("ids", frame.hasObjects ? *frame.ids : noIds)
      .texture("movers", layerTextures.labelsOf(layers))
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .storage("Edges", edges)
      .dispatch((itemsOf(made.texture) + 1) / 2, GL_SHADER_STORAGE_BARRIER_BIT);
  threshold.use()
      .storage("Edges", edges)
      .set("share", share)
      .set("least", kMinEdge)
      .set("most", glm::vec2(static_cast<float>(kMaxDetailUnit), maxLeading))
      .dispatch({1, 1}, GL_SHADER_STORAGE_BARRIER_BIT);
}

void TensorField::State::sumRegions(const scene::ArFrame& frame, const MotionField& motion,
                                    const MotionLayers* layers, const Past& past) {
  TensorPyramidMaker::Level& finest = background.front();
  std::swap(finest.regions, before);
  std::swap(moverRegions, moversBefore);
  // Where the motion of the image is not followed, neither is that of real surfaces.
  const bool hasSurfaces = frame.motion && motion.follows();
  gpu::Program& program = regions.use(frame);
  motion.bindBackward(program);
  program.texture("tensors", gradientOf(frame.size()).texture)
      .texture("before", before)
      .texture("moversBefore", moversBefore)
      .texture("movers", layerTextures.labelsOf(layers))
      .texture("motion", motion.backward())
      .texture("ids", frame.hasObjects ? *frame.ids : noIds)
      .texture("surfaceMotion", hasSurfaces ? *frame.motion->texture : before)
      .set("hasSurfaces", hasSurfaces ? 1 : 0)
      .set("objectBounds", frame.objectBoundsOrAll())
      .storage("Edges", edges)
      .image("regions", finest.regions, gpu::ImageAccess::kWrite)
      .image("moverRegions", moverRegions, gpu::ImageAccess::kWrite)
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .set("fullSize", glm::vec2(full.width, full.height))
      .set("regionPixels", static_cast<float>(kRegionPixels))
      .set("hasPast", past.isThere ? 1 : 0)
      .set("past", past.share)
      .set("slack", past.slack)
      .texture("backgroundActivity", layerTextures.activityOf(layers))
      .set("rests", layers != nullptr && layers->isStanding() ? 1 : 0)
      .dispatch(itemsOf(finest.regions), kWritten);
  pyramid.fill(moverRegions, kMoverSigma, movers);
}

void TensorField::State::sumModels(const scene::ArFrame& frame, double form, const Past& past) {
  if (!frame.hasObjects) {
    if (models) models->hasPast = models->hasPatchesBefore = false;
    return;
  }
  if (!models) models.emplace(background.front().regions.size());
  gpu::Texture& finest = models->levels.front().regions;
  std::swap(finest, models->before);
  std::swap(models->labels, models->labelsBefore);
  const bool goesOn = past.isThere && models->hasPast && frame.motion;
  modelRegions.use()
      .texture("tensors", gradientOf(frame.size()).texture)
      .texture("forms", *frame.forms)
      .texture("normals", *frame.normalFocus)
      .texture("surfaceMotion", frame.motion ? *frame.motion->texture : before)
      .texture("before", models->before)
      .texture("labelsBefore", models->labelsBefore)
      .storage("Edges", edges)
      .image("regions", finest, gpu::ImageAccess::kWrite)
      .image("labels", models->labels, gpu::ImageAccess::kWrite)
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .set("regionPixels", static_cast<float>(kRegionPixels))
      .set("formWeight", static_cast<float>(form))
      .set("hasPast", goesOn ? 1 : 0)
      .set("past", past.share)
      .set("slack", past.slack)
      .dispatch(itemsOf(finest), kWritten);
  models->hasPatchesBefore = goesOn;
  models->hasPast = true;
}

TensorField::TensorField(const gpu::ShaderLibrary& library, hal::FrameSize full)
    : state_(std::make_unique<State>(library, full)) {}

TensorField::~TensorField() = default;

void TensorField::update(const scene::ArFrame& frame, const gpu::Texture& picture,
                         const MotionField& motion, const TensorFieldOptions& options,
                         const MotionLayers* layers, const SegmentMap* segments) {
  State& s = *state_;
  assert(frame.full() == s.full && picture.size() == frame.size());
  assert(options.slack >= 0.0 && options.slack < 1.0);
  assert(options.maxLeading >= kMinEdge && options.maxLeading <= kMaxDetailUnit);
  const hal::Duration step = timeStep(s.lastTime, frame.captureTime);
  const double memory = std::chrono::duration<double>(options.memory).count();
  const bool goesOn = s.hasPast && !motion.isCut();
  const double past = goesOn ? keptAfter(step, memory) : 0.0;
  s.lastTime = frame.captureTime;
  s.hasPast = true;
  s.findEdges(frame, picture, layers, static_cast<float>(1.0 - past),
              static_cast<float>(options.maxLeading));
  const State::Past kept{goesOn, static_cast<float>(past), static_cast<float>(options.slack)};
  s.sumRegions(frame, motion, layers, kept);
  s.pyramid.build(s.background, options.fillSigma,
                  {.map = segments, .regionPixels = kRegionPixels});
  s.sumModels(frame, options.form, kept);
  if (frame.hasObjects) s.pyramid.build(s.models->levels, options.fillSigma);
}

std::size_t TensorField::levelCount() const {
  return state_->background.size();
}

const gpu::Texture& TensorField::resolved(std::size_t level) const {
  return state_->background[level].resolved;
}

const gpu::Texture& TensorField::filled(std::size_t level) const {
  return state_->background[level].filled;
}

const gpu::Texture& TensorField::regions() const {
  return state_->background.front().regions;
}

const gpu::Texture& TensorField::movers() const {
  return state_->movers;
}

const gpu::Texture& TensorField::resolvedModels(std::size_t level) const {
  return (state_->models ? state_->models->levels : state_->background)[level].resolved;
}

const gpu::Texture* TensorField::patches() const {
  return state_->models ? &state_->models->labels : nullptr;
}

const gpu::Texture* TensorField::patchesBefore() const {
  return state_->models && state_->models->hasPatchesBefore ? &state_->models->labelsBefore
                                                            : nullptr;
}

double TensorField::regionPixels(std::size_t level) const {
  return std::ldexp(kRegionPixels, static_cast<int>(level));
}

glm::vec2 TensorField::textureScale(std::size_t level) const {
  const hal::FrameSize size = resolved(level).size();
  return glm::vec2(1.0 / (regionPixels(level) * glm::dvec2(size.width, size.height)));
}

std::size_t TensorField::detailLevel() const {
  return std::min<std::size_t>(1, levelCount() - 1);
}

void TensorField::reset() {
  state_->hasPast = false;
}

}  // namespace pleinair::marks
