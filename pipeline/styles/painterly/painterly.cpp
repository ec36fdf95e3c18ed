#include "pipeline/styles/painterly/painterly.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/gpu/images/per_size.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/marks/anchors/anchor_set.h"
#include "pipeline/marks/fidelity_field.h"
#include "pipeline/marks/focus_field.h"
#include "pipeline/marks/motion_field.h"
#include "pipeline/marks/movers/layer_textures.h"
#include "pipeline/marks/movers/motion_layers.h"
#include "pipeline/marks/strokes/stroke_set.h"
#include "pipeline/marks/tensors/segment_map.h"
#include "pipeline/marks/tensors/tensor_field.h"
#include "pipeline/scene/render/model_hiding.h"
#include "pipeline/styles/painterly/coherence.h"
#include "pipeline/styles/painterly/layers.h"
#include "pipeline/styles/painterly/painterly_views.h"
#include "pipeline/styles/painterly/palette.h"
#include "pipeline/styles/painterly/reduced_images.h"
#include "pipeline/styles/painterly/view_drawing.h"
#include "pipeline/styles/strokes/brush_cache.h"
#include "pipeline/styles/strokes/stroke_borders.h"
#include "pipeline/styles/strokes/stroke_drawing.h"

namespace pleinair::styles {
namespace {

using gpu::Texture;
using gpu::TextureFilter;
using gpu::TextureFormat;

const std::string kShaders = "pipeline/styles/painterly/shaders/";
constexpr double kTexelOfWidth = 0.6;       // that a stroke's colours are of, at most
constexpr std::size_t kGroundHalvings = 2;  // of the first wash
constexpr std::size_t kClipHalvings = 1;    // of the picture that strokes are clipped by
constexpr double kMoverGroundPixels = 4.0;  // that the wash of movers is of, at most

Texture colours(hal::FrameSize size) {
  return {TextureFormat::kRgba8, size, TextureFilter::kLinear};
}

glm::vec3 groundOf(const PainterlyParameters& p) {
  return {p.groundRed, p.groundGreen, p.groundBlue};
}

/// The picture's focus and the scene's.
marks::FocusField focusOf(const scene::ArFrame& frame, const PainterlyParameters& p) {
  const glm::vec2 full(frame.full().width, frame.full().height);
  const glm::vec2 pixelsOfFull(frame.pixelsOfFull());
  marks::FocusField field;
  if (p.focus > 0.0) {
    field.add(full * glm::vec2(p.focusX, p.focusY), full.y * static_cast<float>(p.focusRadius),
              full.y * static_cast<float>(p.focusFalloff), static_cast<float>(p.focus));
  }
  for (const scene::FocusPlace& each : frame.foci) {
    if (each.strength <= 0.0F) continue;
    field.add(each.px / pixelsOfFull, each.radiusPx / pixelsOfFull.y,
              each.falloffPx / pixelsOfFull.y, each.strength);
  }
  return field;
}

/// The textures that are painted on, of one image size.
struct Canvas {
  explicit Canvas(hal::FrameSize pictureSize)
      : size(pictureSize),
        colour(colours(size)),
        height(colours(size)),
        picture(colours(size)),
        borders{Texture(TextureFormat::kR32ui, size), Texture(TextureFormat::kR32ui, size)},
        strokes({&colour, &height}),
        finished({&picture}),
        bordered{gpu::RenderTarget({borders.data()}), gpu::RenderTarget({&borders[1]})} {}

  hal::FrameSize size;
  Texture colour;
  Texture height;
  Texture picture;
  std::array<Texture, 2> borders;  // where strokes are clipped: of this frame and the last one
  std::size_t now = 0;             // which of the two is this frame's
  gpu::RenderTarget strokes;
  gpu::RenderTarget finished;
  std::array<gpu::RenderTarget, 2> bordered;
};

struct Layer {
  Layer(const gpu::ShaderLibrary& library, hal::FrameSize full, const LayerPlan& plan,
        std::size_t number)
      : anchors(library, full, anchorsOf(plan, number)), strokes(library, anchors.slotCount()) {}
  marks::AnchorSet anchors;
  marks::StrokeSet strokes;
  StrokeStrips strips;
};

/// The state that belongs to one full size and plan.
struct Painting {
  Painting(const gpu::ShaderLibrary& library, hal::FrameSize fullSize, const LayerPlan& given)
      : full(fullSize),
        plan(given),
        motion(library, full),
        movers(library, full),
        field(library, full) {
    for (std::size_t i = 0; i < plan.layers; ++i) {
      layers.push_back(std::make_unique<Layer>(library, full, plan, i));
    }
  }
  hal::FrameSize full;
  LayerPlan plan;
  marks::MotionField motion;
  marks::MotionLayers movers;
  marks::SegmentMap segments;
  marks::TensorField field;
  std::vector<std::unique_ptr<Layer>> layers;
};

/// The same image as if a camera had taken all of it.
scene::ArFrame withoutModels(const scene::ArFrame& frame) {
  scene::ArFrame image = frame;
  image.cameraColour = nullptr;
  image.hasObjects = false;
  image.motion.reset();
  image.surfaces.reset();
  return image;
}

}  // namespace

struct Painterly::State {
  explicit State(const gpu::ShaderLibrary& shaders)
      : library(shaders),
        reduced(library),
        ground(library.fragmentPass(kShaders + "ground.frag", {},
                                    {TextureFormat::kRgba8, TextureFormat::kRgba8})),
        relief(library.fragmentPass(kShaders + "relief.frag", {}, {TextureFormat::kRgba8})),
        views(library),
        hiding(library),
        borders(library),
        linen(library, Substrate::Kind::kLinen),
        paper(library, Substrate::Kind::kPaper),
        strips(library),
        drawing(library, painterlyViews()),
        brushes(library),
        noIds(TextureFormat::kR32ui, {1, 1}),
        drawsOnProcessor(gpu::inspectCurrentContext("painter").isSoftware) {}

  const gpu::ShaderLibrary& library;
  ReducedImages reduced;
  gpu::Program ground;
  gpu::Program relief;
  ViewDrawing views;
  scene::ModelHiding hiding;
  StrokeBorders borders;
  Substrate linen;
  Substrate paper;
  StrokeStripMaker strips;
  StrokeDrawing drawing;
  BrushCache brushes;
  Texture noIds;
  /// A software renderer draws a layer while the next one is laid out, if it is told to begin; what
  /// draws in tiles would store and load them for each.
  bool drawsOnProcessor;
  marks::LayerTextures layerTextures;
  std::string palette = "all";  // that `mixtures` are of
  std::optional<Texture> mixtures;
  std::unique_ptr<Painting> painting;
  gpu::PerSize<Canvas> canvases;
  Canvas* canvas = nullptr;       // of this frame
  Canvas* bordered = nullptr;     // that of the last frame, if it has its borders
  const Texture* clip = nullptr;  // this frame's borders, if there can be any

  /// Null where movers are not told apart.
  const marks::MotionLayers* moversOf(const PainterlyParameters& p) const {
    return tellsMovers(p) ? &painting->movers : nullptr;
  }
  void take(const scene::ArFrame& frame, const PainterlyParameters& p);
  void grow(const scene::ArFrame& frame, const PainterlyParameters& p);
  /// Finds where strokes are clipped: nowhere where they are not, or where nothing virtual is seen,
  /// movers are not told apart, and there are no segments.
  void findBorders(const scene::ArFrame& frame, const PainterlyParameters& p);
  void drawStrokes(const scene::ArFrame& frame, const PainterlyParameters& p);
  void light(const scene::ArFrame& frame, const PainterlyParameters& p);
  void showStrokes(const scene::ArFrame& frame, std::size_t view);
  const Texture& show(const scene::ArFrame& frame, const PainterlyParameters& p, std::size_t view);
};

void Painterly::State::take(const scene::ArFrame& frame, const PainterlyParameters& p) {
  canvas = nullptr;
  clip = nullptr;
  const LayerPlan plan = planOf(p, frame.full());
  if (painting == nullptr || painting->full != frame.full() || painting->plan != plan) {
    if (painting != nullptr && painting->full != frame.full()) {
      canvases.clear();
      reduced.clear();
      bordered = nullptr;
    }
    painting.reset();
    painting = std::make_unique<Painting>(library, frame.full(), plan);
  }
  canvas = &canvases.of(frame.size(), frame.size());
  if (palette != p.palette) {
    const Pigments pigments = pigmentsOf(p.palette);
    mixtures.reset();
    if (!pigments.empty()) mixtures = makeMixtures(pigments);
    palette = p.palette;
  }
}

void Painterly::State::grow(const scene::ArFrame& frame, const PainterlyParameters& p) {
  painting->motion.update(frame, motionOf(p));
  const marks::MotionLayers* const movers = moversOf(p);
  if (movers != nullptr) {
    painting->movers.update(frame, painting->motion);
    if (const auto cover = movers->cover()) hiding.hide(frame, *cover);
  } else {
    painting->movers.reset();
  }
  painting->segments.update(frame);
  findBorders(frame, p);
  const Texture* const labels = painting->segments.hasSegments() ? clip : nullptr;
  reduced.update(frame, movers);
  painting->field.update(frame, *frame.colour, painting->motion, fieldOf(p), movers,
                         &painting->segments);
  const marks::FocusField focus = focusOf(frame, p);
  const marks::FidelityField fidelity =
      marks::fidelityOfFaces(frame, p.faces, painting->plan.finestPixels);
  for (std::size_t i = 0; i < painting->layers.size(); ++i) {
    Layer& layer = *painting->layers[i];
    if (p.coherence <= 0.0) layer.anchors.beginAnew();
    marks::AnchorHold hold = anchorHoldOf(p);
    const bool isFinest = i + 1 == painting->layers.size();
    if (isFinest) hold.fidelity = fidelity;
    layer.anchors.advance(frame, painting->motion, hold, movers, &painting->field);
    marks::StrokeRule rule = ruleOf(p, painting->plan, i, painting->motion.noiseLevels());
    rule.mixtures = mixtures ? &*mixtures : nullptr;
    rule.focus = focus;
    rule.fidelity = fidelity;
    rule.isFaithful = isFinest;
    const double width = widthOf(painting->plan, i) * frame.pixelsOfFull().x;
    const double texel = kTexelOfWidth * width;
    layer.strokes.update(frame, layer.anchors, painting->field,
                         p.clip ? reduced.paintOf(texel) : reduced.wholePaintOf(texel), rule,
                         movers, labels);
  }
}

void Painterly::State::findBorders(const scene::ArFrame& frame, const PainterlyParameters& p) {
  const marks::SegmentMap& segments = painting->segments;
  const Canvas* const last = bordered;
  bordered = nullptr;
  clip = nullptr;
  if (!p.clip) return;
  if (!frame.hasObjects && !tellsMovers(p) && !segments.hasSegments()) return;
  const bool isHeld = last == canvas && painting->motion.isStanding() && !painting->motion.isCut();
  const Texture& before = canvas->borders.at(canvas->now);
  canvas->now = 1 - canvas->now;
  borders.draw(frame, moversOf(p), canvas->bordered.at(canvas->now), &segments,
               isHeld ? &before : nullptr);
  bordered = canvas;
  clip = &canvas->borders.at(canvas->now);
}

void Painterly::State::drawStrokes(const scene::ArFrame& frame, const PainterlyParameters& p) {
  StripClipping clipping{.clips = clip != nullptr};
  if (!frame.hasObjects && !painting->segments.hasSegments() && moversOf(p) != nullptr) {
    clipping.onlyMovers = moversOf(p)->busyBlocks();
  }
  // All of them before any is drawn: what is drawn on stays in a tile's memory (docs/gpu.md).
  for (const auto& layer : painting->layers) {
    strips.lay(layer->strokes.instances(), layer->strokes.command(), p.quads, layer->strips,
               clipping);
  }
  ground.use()
      .texture("paint", reduced.whole(kGroundHalvings))
      .texture("moverPaint", *reduced.paintOf(kMoverGroundPixels).movers)
      .texture("movers", layerTextures.labelsOf(moversOf(p)))
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .set("size", glm::vec2(canvas->size.width, canvas->size.height))
      .set("ground", groundOf(p))
      .set("wash", static_cast<float>(p.wash))
      .texture("mixtures", mixtures ? *mixtures : *frame.colour)
      .set("isLimited", mixtures ? 1 : 0)
      .texture("borders", clip != nullptr ? *clip : noIds)
      .set("hasBorders", clip != nullptr ? 1 : 0)
      .drawFullscreen(canvas->strokes);
  const StrokeLight light{.each = p.bump == StrokeBump::kEach,
                          .relief = static_cast<float>(p.relief),
                          .gloss = static_cast<float>(p.gloss)};
  const StrokeClip clipped{.borders = clip,
                           .onlyMovers = clipping.onlyMovers.has_value(),
                           .picture = &reduced.whole(kClipHalvings),
                           .colour = p.coherence < 1.0 ? static_cast<float>(p.colourClip) : 0.0F,
                           .byLuma = mixtures.has_value()};
  for (std::size_t i = 0; i < painting->layers.size(); ++i) {
    const Texture& brush = brushes.brush(p.brush, texelsOf(painting->plan, i));
    drawing.draw(painting->layers[i]->strips, brush, light, clipped, painting->full,
                 canvas->strokes);
    if (drawsOnProcessor) glFlush();
  }
}

void Painterly::State::light(const scene::ArFrame& frame, const PainterlyParameters& p) {
  const Substrate& substrate = p.support == Substrate::Kind::kLinen ? linen : paper;
  substrate.bind(relief.use(), frame);
  relief.texture("colours", canvas->colour)
      .texture("heights", canvas->height)
      .texture("borders", clip != nullptr ? *clip : noIds)
      .set("hasBorders", clip != nullptr ? 1 : 0)
      .texture("movers", layerTextures.labelsOf(moversOf(p)))
      .texture("frame", *frame.colour)
      .texture("ids", frame.hasObjects ? *frame.ids : noIds)
      .set("hasObjects", frame.hasObjects ? 1 : 0)
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .texture("normalFocus", frame.hasFocus ? *frame.normalFocus : *frame.colour)
      .set("hasFocus", frame.hasFocus ? 1 : 0)
      .set("relief", p.bump == StrokeBump::kOnce ? static_cast<float>(p.relief) : 0.0F)
      .set("gloss", p.bump == StrokeBump::kOnce ? static_cast<float>(p.gloss) : 0.0F)
      .set("weave", static_cast<float>(p.canvas))
      .set("tooth", static_cast<float>(p.tooth))
      .set("wash", static_cast<float>(p.wash))
      .set("ground", groundOf(p))
      .set("saturation", static_cast<float>(p.saturation))
      .set("warmth", static_cast<float>(p.warmth))
      .drawFullscreen(canvas->finished);
}

/// Over a pale picture.
void Painterly::State::showStrokes(const scene::ArFrame& frame, std::size_t view) {
  ground.use()
      .texture("paint", *frame.colour)
      .set("size", glm::vec2(canvas->size.width, canvas->size.height))
      .set("ground", glm::vec3(0.95F))
      .set("wash", 0.35F)
      .texture("mixtures", *frame.colour)
      .set("isLimited", 0)
      .texture("borders", noIds)
      .set("hasBorders", 0)
      .drawFullscreen(canvas->strokes);
  for (std::size_t i = 0; i < painting->layers.size(); ++i) {
    const float part =
        static_cast<float>(i) / std::max(1.0F, static_cast<float>(painting->layers.size() - 1));
    drawing.show(painting->layers[i]->strokes, kQuads, view, layerColour(part), painting->full,
                 canvas->strokes);
  }
}

const Texture& Painterly::State::show(const scene::ArFrame& frame, const PainterlyParameters& p,
                                      std::size_t view) {
  const glm::vec2 bands(p.middleDetail, p.detail);
  const gpu::RenderTarget& target = canvas->finished;
  switch (viewerOf(view)) {
    case PainterlyViewer::kField:
      views.showField(frame, painting->field, focusOf(frame, p), bands, view, target);
      break;
    case PainterlyViewer::kStrokes:
      showStrokes(frame, view);
      return canvas->colour;
    case PainterlyViewer::kMovers:
      views.showMovers(frame, moversOf(p), view, target);
      break;
    case PainterlyViewer::kSegments:
      views.showSegments(frame, clip, target);
      break;
    case PainterlyViewer::kFeatures:
      views.showFeatures(frame, target);
      break;
    case PainterlyViewer::kHeight:
      drawStrokes(frame, p);
      views.showHeight(canvas->height, target);
      break;
  }
  return canvas->picture;
}

Painterly::Painterly(const gpu::ShaderLibrary& library, SceneContents contents)
    : values_(painterlyParameters().defaults()), state_(std::make_unique<State>(library)) {
  warmUp(contents);
}

Painterly::~Painterly() = default;

/// A program's real cost on software renderers is at its first use: here, not in the first frame
/// that shows a model, has a focus or is looked at in another way.
void Painterly::warmUp(SceneContents contents) {
  constexpr hal::FrameSize kSize{16, 16};
  constexpr int kWarmUpTexels = 8;
  const std::vector<std::uint8_t> zeros(std::size_t{16} * 16 * 4);
  Texture grey(TextureFormat::kRgba8, kSize, TextureFilter::kLinear);
  grey.upload(zeros, std::size_t{16} * 4);
  Texture ids(TextureFormat::kR32ui, kSize);
  ids.upload(zeros, std::size_t{16} * 4);
  scene::ArFrame frame{
      .colour = &grey, .ids = &ids, .normalFocus = &grey, .barycentrics = &ids, .forms = &ids};
  const bool hasModels = contents == SceneContents::kModels;
  frame.sceneHasModels = hasModels;
  for (const DebugViewInfo& view : painterlyViews()) paint(frame, view.name);
  for (const StrokeBump bump : {StrokeBump::kEach, StrokeBump::kOnce}) {
    p_.bump = bump;
    for (const bool isShown : {true, false}) {
      frame.hasObjects = frame.hasFocus = isShown && hasModels;
      ++frame.sequence;
      paint(frame, {});
    }
  }
  state_->drawing.warmUp(state_->brushes.brush(p_.brush, kWarmUpTexels), ids,
                         state_->canvas->strokes);
  if (hasModels) state_->hiding.warmUp();
  p_ = painterlyParameters().typed(values_);
  state_->painting.reset();
  state_->canvas = nullptr;
  state_->bordered = nullptr;
  state_->canvases.clear();
  state_->reduced.clear();
}

scene::ArFrameNeeds Painterly::needs() const {
  scene::ArFrameNeeds needs = kind().needs;
  needs.segments = p_.segments;
  needs.faces = p_.faces > 0.0;
  return needs;
}

hal::Result<void> Painterly::prepare(const config::ParameterValues& values) {
  return state_->brushes.take(painterlyParameters().typed(values).brushFile);
}

void Painterly::setParameters(const config::ParameterValues& values) {
  if (values == values_) return;
  p_ = painterlyParameters().typed(values);
  values_ = values;
}

const Texture& Painterly::paint(const scene::ArFrame& frame, std::string_view view) {
  State& s = *state_;
  const scene::ArFrame seen = p_.modelSpace ? frame : withoutModels(frame);
  s.take(seen, p_);
  s.grow(seen, p_);
  if (!view.empty()) return s.show(seen, p_, viewIndex(painterlyViews(), view));
  s.drawStrokes(seen, p_);
  s.light(seen, p_);
  return s.canvas->picture;
}

const marks::AnchorSet* Painterly::anchors() const {
  return state_->painting ? &state_->painting->layers.back()->anchors : nullptr;
}

std::vector<marks::Anchor> Painterly::readAnchors() const {
  std::vector<marks::Anchor> all;
  for (std::size_t i = 0; i < layerCount(); ++i) {
    const std::vector<marks::Anchor> some = layer(i).anchors.read();
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

const marks::MotionLayers* Painterly::movers() const {
  return state_->painting && tellsMovers(p_) ? &state_->painting->movers : nullptr;
}

std::size_t Painterly::layerCount() const {
  return state_->painting ? state_->painting->layers.size() : 0;
}

Painterly::PaintedLayer Painterly::layer(std::size_t number) const {
  const Layer& layer = *state_->painting->layers.at(number);
  return {layer.anchors, layer.strokes};
}

void Painterly::reset() {
  if (!state_->painting) return;
  state_->bordered = nullptr;
  state_->painting->motion.reset();
  state_->painting->movers.reset();
  state_->painting->field.reset();
  for (const auto& layer : state_->painting->layers) layer->anchors.reset();
}

}  // namespace pleinair::styles
