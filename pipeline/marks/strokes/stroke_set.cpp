#include "pipeline/marks/strokes/stroke_set.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/gpu/programs/program.h"
#include "pipeline/marks/fading_past.h"
#include "pipeline/marks/movers/layer_textures.h"

namespace pleinair::marks {
namespace {

const std::string kShaders = "pipeline/marks/strokes/shaders/";
const std::string kTrace = kShaders + "stroke_trace.comp";
constexpr std::size_t kStrokeBytes = 96;  // shaders/stroke.glsl
constexpr glm::ivec2 kArms{2, 4};         // of a stroke; segments of each
// The bits of labels in borders (shaders/stroke_label.glsl) and in forms (surface_form.glsl).
constexpr unsigned kBorderLabels = 8191;
constexpr unsigned kFormLabels = 4095;

// The commands that trace each list (shaders/stroke_lists.glsl), in bytes, and their words before
// anything is listed.
constexpr std::size_t kOnModels = 0;
constexpr std::size_t kWithLabels = 16;
constexpr std::size_t kMoversOnly = 32;
constexpr std::array<std::uint32_t, 12> kEmptyLists{0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0};

/// A number near the golden section of n and coprime to it, so that neighbouring slots are far
/// apart in the painting order; smaller where its products would not fit into 32 bits
/// (shaders/stroke_order.comp).
std::uint32_t strideFor(std::uint32_t n) {
  constexpr std::uint32_t kLargest = std::numeric_limits<std::uint32_t>::max();
  auto stride = std::max(1U, static_cast<std::uint32_t>(0.618 * n));
  stride = std::min(stride, std::max(1U, kLargest / std::max(n, 1U)));
  while (std::gcd(stride, n) != 1U) --stride;
  return stride;
}

}  // namespace

struct StrokeSet::State {
  State(const gpu::ShaderLibrary& shaderLibrary, std::uint32_t slotCount)
      : library(shaderLibrary),
        slots(slotCount),
        carry(library.compute(kShaders + "stroke_carry.comp")),
        list(library.compute(kShaders + "stroke_lists.comp")),
        order(library.compute(kShaders + "stroke_order.comp")),
        lay(library.compute(kShaders + "stroke_instances.comp")),
        strokes(slots * kStrokeBytes, gpu::BufferUsage::kDynamic),
        lists(sizeof(kEmptyLists) + slots * sizeof(std::uint32_t), gpu::BufferUsage::kDynamic),
        ranks(slots * sizeof(std::uint32_t), gpu::BufferUsage::kDynamic),
        command(gpu::kDrawCommandBytes, gpu::BufferUsage::kDynamic),
        instances(slots * kInstanceBytes, gpu::BufferUsage::kDynamic),
        noIds(gpu::TextureFormat::kR32ui, {1, 1}),
        anyColour(gpu::TextureFormat::kRgba8, {1, 1}) {
    strokes.write(std::vector<std::byte>(strokes.sizeBytes()));
    lists.write(std::as_bytes(std::span(kEmptyLists)));
  }

  const gpu::ShaderLibrary& library;
  std::uint32_t slots;
  gpu::Program carry;
  gpu::Program list;
  std::optional<gpu::Program> traceOnModels;
  std::optional<gpu::Program> traceWithLabels;  // the background's that may meet labels
  std::optional<gpu::Program> traceMoversOnly;  // all others
  gpu::Program order;
  gpu::Program lay;
  gpu::Buffer strokes;
  gpu::Buffer lists;
  gpu::Buffer ranks;
  gpu::Buffer command;
  gpu::Buffer instances;
  gpu::Texture noIds;
  gpu::Texture anyColour;
  LayerTextures layerTextures;
  hal::TimePoint lastTime;

  void listAll(const scene::ArFrame& frame, const AnchorSet& anchors, const StrokeRule& rule,
               const gpu::Texture* borders);
  glm::ivec2 allSlots() const { return {static_cast<int>(slots), 1}; }
  void carryWithObjects(const scene::ArFrame& frame, const AnchorSet& anchors,
                        const StrokeRule& rule);
  /// Lists the strokes and traces them, by three programs: one for strokes on models, beside them
  /// and on movers needs more registers than a Raspberry Pi has.
  void grow(const scene::ArFrame& frame, const AnchorSet& anchors, const TensorField& field,
            const StrokePaint& paint, const StrokeRule& rule, const MotionLayers* layers,
            const gpu::Texture* borders, hal::Duration step);
  void traceListed(gpu::Program& program, std::size_t groups, const scene::ArFrame& frame,
                   const AnchorSet& anchors, const TensorField& field, const StrokePaint& paint,
                   const StrokeRule& rule, const MotionLayers* layers, const gpu::Texture* borders,
                   hal::Duration step);
  void layOut(const AnchorSet& anchors, const StrokeRule& rule);
};

namespace {

/// The focal length of the full image's camera, px.
float focalOf(const scene::SurfaceAccess& surfaces, const scene::ArFrame& frame) {
  return static_cast<float>(surfaces.camera->intrinsics().fy / frame.pixelsOfFull().y);
}

}  // namespace

void StrokeSet::State::carryWithObjects(const scene::ArFrame& frame, const AnchorSet& anchors,
                                        const StrokeRule& rule) {
  if (!frame.hasObjects || anchors.hasBegunAnew()) return;
  carry.use()
      .storage("Anchors", anchors.anchors())
      .storage("Strokes", strokes)
      .texture("motion", frame.motion ? *frame.motion->texture : anyColour)
      .set("hasMotion", frame.motion ? 1 : 0)
      .texture("ids", *frame.ids)
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .set("segment", rule.segmentPx)
      .set("arms", kArms)
      .set("slots", slots)
      .dispatch(allSlots(), GL_SHADER_STORAGE_BARRIER_BIT);
}

void StrokeSet::State::listAll(const scene::ArFrame& frame, const AnchorSet& anchors,
                               const StrokeRule& rule, const gpu::Texture* borders) {
  list.use()
      .storage("Anchors", anchors.anchors())
      .storage("Strokes", strokes)
      .storage("StrokeLists", lists)
      .set("slots", slots)
      .set("segment", rule.segmentPx)
      .set("hasObjects", frame.hasObjects ? 1 : 0)
      .set("objectBounds", frame.objectBoundsOrAll())
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .set("hasSegments", borders != nullptr ? 1 : 0)
      .dispatch({1, 1}, GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

void StrokeSet::State::grow(const scene::ArFrame& frame, const AnchorSet& anchors,
                            const TensorField& field, const StrokePaint& paint,
                            const StrokeRule& rule, const MotionLayers* layers,
                            const gpu::Texture* borders, hal::Duration step) {
  listAll(frame, anchors, rule, borders);
  const auto trace = [&](gpu::Program& program, std::size_t groups) {
    traceListed(program, groups, frame, anchors, field, paint, rule, layers, borders, step);
  };
  if (frame.mayHaveObjects()) {
    if (!traceOnModels) traceOnModels = library.compute(kTrace, {{"ON_MODELS"}});
    trace(*traceOnModels, kOnModels);
  }
  if (frame.mayHaveObjects() || borders != nullptr) {
    if (!traceWithLabels) traceWithLabels = library.compute(kTrace);
    trace(*traceWithLabels, kWithLabels);
  }
  if (!traceMoversOnly) traceMoversOnly = library.compute(kTrace, {{"MOVERS_ONLY"}});
  trace(*traceMoversOnly, kMoversOnly);
}

void StrokeSet::State::traceListed(gpu::Program& program, std::size_t groups,
                                   const scene::ArFrame& frame, const AnchorSet& anchors,
                                   const TensorField& field, const StrokePaint& paint,
                                   const StrokeRule& rule, const MotionLayers* layers,
                                   const gpu::Texture* borders, hal::Duration step) {
  const auto stays = [step](hal::Duration timeConstant) {
    return keptAfter(step, hal::toSeconds(timeConstant));
  };
  const std::size_t level = std::min(rule.fieldLevel, field.levelCount() - 1);
  const bool hasDepth = frame.hasObjects && frame.depth != nullptr;
  const std::size_t detail = field.detailLevel();
  const bool isOnModels = groups == kOnModels;
  program.use()
      .storage("Anchors", anchors.anchors())
      .storage("Strokes", strokes)
      .storage("StrokeLists", lists)
      .texture("field", isOnModels ? field.resolvedModels(level) : field.resolved(level))
      .texture("detailField", isOnModels ? field.resolvedModels(detail) : field.resolved(detail))
      .texture("moverField", field.movers())
      .texture("paint", *paint.background)
      .texture("moverPaint", *paint.movers)
      .texture("modelPaint", *paint.models)
      .texture("moverShares", layerTextures.sharesOf(layers))
      .texture("background", layerTextures.backgroundOf(layers))
      .texture("moverMotion", layerTextures.moverMotionOf(layers))
      .texture("finePaint", *paint.fineModels)
      .texture("fineGround",
               paint.fineBackground != nullptr ? *paint.fineBackground : *paint.background)
      .set("paintTexel", paint.modelTexelPx)
      .texture("ids", frame.hasObjects ? *frame.ids : noIds)
      .texture("labels", borders != nullptr ? *borders
                         : frame.hasObjects ? *frame.forms
                                            : noIds)
      .set("labelMask", borders != nullptr ? kBorderLabels : kFormLabels)
      .texture("depth", hasDepth ? *frame.depth : anyColour)
      .set("depthRange", hasDepth ? glm::vec2(frame.nearMetres, frame.farMetres) : glm::vec2(0.0F))
      .set("objectBounds", frame.objectBoundsOrAll())
      .set("anew", anchors.hasBegunAnew() ? 1 : 0)
      .set("fullSize", glm::vec2(frame.full().width, frame.full().height))
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .set("fieldScale", field.textureScale(level))
      .set("detailScale", field.textureScale(detail))
      .set("moverScale", field.textureScale(0))
      .set("slots", slots)
      .set("segment", rule.segmentPx)
      .set("steps", rule.steps)
      .set("minSteps", rule.minSteps)
      .set("colourThreshold", rule.colourThreshold)
      .set("cutOff", std::cos(rule.cutOffRad))
      .set("detailBand", rule.detailBand)
      .set("modelDetail", rule.modelDetail)
      .set("detailSpread", rule.detailSpread)
      .set("slack", rule.slack)
      .set("arms", kArms)
      .set("bothWays", rule.bothWays ? 1 : 0)
      .set("wander", rule.wanderRad)
      .set("past", glm::vec4(stays(rule.shapeMemory), stays(rule.colourMemory),
                             stays(rule.appearing), stays(rule.vanishing)))
      .set("otherColour", rule.otherColour)
      .set("flatDetail", rule.flatDetail)
      .set("flatHold", rule.flatHold)
      .set("restSlack", rule.restSlack)
      .set("looseness", rule.looseness)
      .set("clips", rule.clips ? 1 : 0)
      .set("loosePx", rule.looseSpeed * static_cast<float>(hal::toSeconds(step)) *
                          static_cast<float>(frame.full().height))
      .set("isStanding", layers != nullptr && layers->hasStood() ? 1 : 0)
      .set("maxColour", rule.maxColourPerSecond * static_cast<float>(hal::toSeconds(step)))
      .set("imageScale", static_cast<float>(anchors.imageScale()))
      .set("focalPx", frame.surfaces ? focalOf(*frame.surfaces, frame) : 0.0F)
      .set("layer", glm::vec2(rule.layer, rule.layers))
      .set("width", rule.widthPx);
  if (program.hasUniform("beside")) program.set("beside", rule.besidePx);
  if (program.hasUniform("backgroundActivity"))
    program.texture("backgroundActivity", layerTextures.activityOf(layers));
  if (program.hasUniform("hasSegments")) program.set("hasSegments", borders != nullptr ? 1 : 0);
  rule.focus.bind(program);
  (rule.isFaithful ? rule.fidelity : FidelityField{}).bind(program);
  program.dispatchListed(lists, groups, program.groupsFor({static_cast<int>(slots), 1}),
                         GL_SHADER_STORAGE_BARRIER_BIT);
}

void StrokeSet::State::layOut(const AnchorSet& anchors, const StrokeRule& rule) {
  order.use()
      .storage("Strokes", strokes)
      .storage("Ranks", ranks)
      .storage("Command", command)
      .set("slots", slots)
      .set("stride", strideFor(slots))
      .set("vertices", static_cast<unsigned>(verticesOf(rule.quads)))
      .dispatch({1, 1}, GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  lay.use()
      .storage("Anchors", anchors.anchors())
      .storage("Strokes", strokes)
      .storage("Ranks", ranks)
      .storage("Instances", instances)
      .set("slots", slots)
      .set("segment", rule.segmentPx)
      .set("width", rule.widthPx)
      .set("widthSpread", rule.widthSpread)
      .set("opacity", rule.opacity)
      .set("leaveLight", rule.leaveLight)
      .texture("mixtures", rule.mixtures != nullptr ? *rule.mixtures : anyColour)
      .set("isLimited", rule.mixtures != nullptr ? 1 : 0)
      .set("jitter", rule.jitter)
      .set("points", 8);
  rule.fidelity.bind(lay);
  lay.dispatch(allSlots(), GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

StrokeSet::StrokeSet(const gpu::ShaderLibrary& library, std::uint32_t slotCount)
    : state_(std::make_unique<State>(library, slotCount)) {}

StrokeSet::~StrokeSet() = default;

void StrokeSet::update(const scene::ArFrame& frame, const AnchorSet& anchors,
                       const TensorField& field, const StrokePaint& paint, const StrokeRule& rule,
                       const MotionLayers* layers, const gpu::Texture* borders) {
  State& s = *state_;
  assert(anchors.slotCount() == s.slots);
  const hal::Duration step = timeStep(s.lastTime, frame.captureTime);
  s.lastTime = frame.captureTime;
  s.carryWithObjects(frame, anchors, rule);
  s.grow(frame, anchors, field, paint, rule, layers, borders, step);
  s.layOut(anchors, rule);
}

const gpu::Buffer& StrokeSet::instances() const {
  return state_->instances;
}

const gpu::Buffer& StrokeSet::command() const {
  return state_->command;
}

const gpu::Buffer& StrokeSet::strokes() const {
  return state_->strokes;
}

}  // namespace pleinair::marks
