#include "pipeline/styles/hatching/hatching.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "pipeline/gpu/images/per_size.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/marks/filtered_frame.h"
#include "pipeline/marks/movers/layer_textures.h"
#include "pipeline/scene/render/model_hiding.h"
#include "pipeline/styles/hatching/drawing_plan.h"
#include "pipeline/styles/hatching/drawing_tone.h"
#include "pipeline/styles/hatching/hatching_shaders.h"
#include "pipeline/styles/strokes/brush_cache.h"
#include "pipeline/styles/strokes/stroke_borders.h"
#include "pipeline/styles/strokes/stroke_drawing.h"
#include "pipeline/styles/strokes/strokes_shaders.h"
#include "pipeline/styles/substrate/substrate.h"
#include "pipeline/styles/substrate/substrate_shaders.h"

namespace pleinair::styles {
namespace {

using gpu::Texture;
using gpu::TextureFilter;
using gpu::TextureFormat;

const std::string kShaders = "pipeline/styles/hatching/shaders/";
constexpr float kMinContourStep = 0.8F;  // px of the image
constexpr int kBrushTexelsAcross = 16;

constexpr std::array kViews{
    DebugViewInfo{"sets", "the lines of each direction in a colour of their own"},
    DebugViewInfo{"ranks", "lines by their rank: red ones are drawn in light tones already"},
    DebugViewInfo{"tone", "the tone that lines render"},
    DebugViewInfo{"edges", "differences across edges, from which contours are found"},
    DebugViewInfo{"contours", "contour lines alone"},
};
constexpr std::array<glm::vec3, kMaxHatchSets> kSetColours{
    {{0.1F, 0.3F, 0.8F}, {0.85F, 0.25F, 0.1F}, {0.1F, 0.6F, 0.25F}}};

constexpr auto kMax = CoherenceGate::Side::kMax;
constexpr auto kMin = CoherenceGate::Side::kMin;
/// The limits that its drawings are held to (docs/measuring.md).
constexpr std::array kGates{
    CoherenceGate{CoherenceMeasure::kNHw2, kMax, 0.10, false, GateMotion::kPan},
    CoherenceGate{CoherenceMeasure::kNHw2, kMax, 0.20, false, GateMotion::kOtherKnown},
    CoherenceGate{CoherenceMeasure::kS10, kMin, 90, false, GateMotion::kPan},
    CoherenceGate{CoherenceMeasure::kPop, kMax, 5, false, GateMotion::kPan},
    CoherenceGate{CoherenceMeasure::kXFlk, kMax, 0.5},
    CoherenceGate{CoherenceMeasure::kDep, kMin, 0.75, true, GateMotion::kPan},
};
/// All of them: lines leave most of the paper bare.
constexpr std::array<std::string_view, 6> kPaperLooks{"pen",       "pencil", "engraving",
                                                      "blueprint", "chalk",  "crayon"};

/// The textures that are drawn on, of one image size.
struct Canvas {
  explicit Canvas(hal::FrameSize pictureSize)
      : size(pictureSize),
        edges(TextureFormat::kRg16f, size, TextureFilter::kLinear),
        contours(TextureFormat::kRg8, size, TextureFilter::kLinear),
        borders(TextureFormat::kR32ui, size),
        ink(TextureFormat::kRgba8, size, TextureFilter::kLinear),
        picture(TextureFormat::kRgba8, size, TextureFilter::kLinear),
        edgesTarget({&edges}),
        contoursTarget({&contours}),
        bordersTarget({&borders}),
        inkTarget({&ink}),
        pictureTarget({&picture}) {}

  hal::FrameSize size;
  Texture edges;
  Texture contours;
  Texture borders;  // where lines are clipped
  Texture ink;
  Texture picture;
  gpu::RenderTarget edgesTarget;
  gpu::RenderTarget contoursTarget;
  gpu::RenderTarget bordersTarget;
  gpu::RenderTarget inkTarget;
  gpu::RenderTarget pictureTarget;
};

/// The state that belongs to one full size and plan.
struct Drawing {
  Drawing(const gpu::ShaderLibrary& library, hal::FrameSize fullSize, const DrawingPlan& given)
      : full(fullSize),
        plan(given),
        motion(library, full),
        movers(library, full),
        field(library, full) {
    for (std::size_t i = 0; i < plan.sets; ++i) {
      HatchPlan lines = plan.lines;
      lines.seed = lines.seed * 8U + static_cast<unsigned>(i);
      sets.push_back(std::make_unique<HatchLines>(library, full, lines));
    }
  }
  hal::FrameSize full;
  DrawingPlan plan;
  marks::MotionField motion;
  marks::MotionLayers movers;
  marks::TensorField field;
  std::vector<std::unique_ptr<HatchLines>> sets;
};

/// The programs that draw lines; `clipped` keeps each on what it lies on.
struct LinePrograms {
  gpu::Program plain, clipped;
};

LinePrograms linesOf(const gpu::ShaderLibrary& library, gpu::ShaderDefines defines) {
  const auto make = [&] {
    return library.draw(kShaders + "line.vert", kShaders + "line.frag", defines);
  };
  gpu::Program plain = make();
  defines.push_back({"CLIPPED"});
  return {.plain = std::move(plain), .clipped = make()};
}

}  // namespace

struct Hatching::State {
  explicit State(const gpu::ShaderLibrary& shaders)
      : library(shaders),
        hiding(library),
        filtered(library),
        tone(library),
        contourEdges(
            library.fragmentPass(kShaders + "contour_edges.frag", {}, {TextureFormat::kRg16f})),
        contourLines(library.fragmentPass(kShaders + "contours.frag", {}, {TextureFormat::kRg8})),
        contourLinesOfModels(
            library.fragmentPass(kShaders + "contours.frag", {{"MODELS"}}, {TextureFormat::kRg8})),
        lines(linesOf(library, {})),
        grainyLines(linesOf(library, {{"GRAIN"}})),
        borders(library),
        compose(library.fragmentPass(kShaders + "compose.frag", {}, {TextureFormat::kRgba8})),
        view(library.fragmentPass(kShaders + "view.frag", viewDefines(kViews))),
        paper(library, Substrate::Kind::kPaper),
        brushes(library),
        noIds(TextureFormat::kR32ui, {1, 1}) {}

  const gpu::ShaderLibrary& library;
  scene::ModelHiding hiding;
  marks::FilteredFrame filtered;
  DrawingTone tone;
  gpu::Program contourEdges;
  gpu::Program contourLines;
  gpu::Program contourLinesOfModels;
  LinePrograms lines;
  LinePrograms grainyLines;
  StrokeBorders borders;
  gpu::Program compose;
  gpu::Program view;
  Substrate paper;
  StripDrawing strips;
  BrushCache brushes;
  Texture noIds;
  marks::LayerTextures layerTextures;
  std::unique_ptr<Drawing> drawing;
  gpu::PerSize<Canvas> canvases;
  Canvas* canvas = nullptr;         // of this frame
  const Texture* source = nullptr;  // the image that tones and contours are taken from

  const marks::MotionLayers* moversOf(const HatchingParameters& p) const {
    return p.movers ? &drawing->movers : nullptr;
  }
  void take(const scene::ArFrame& frame, const HatchingParameters& p);
  void follow(const scene::ArFrame& frame, const HatchingParameters& p);
  void findContours(const scene::ArFrame& frame, const HatchingParameters& p);
  void drawPart(StripPart part, bool isClipped, const scene::ArFrame& frame,
                const HatchingParameters& p, const StrokeStrips& laid);
  void drawLines(const scene::ArFrame& frame, const HatchingParameters& p, std::string_view name);
  void finish(const scene::ArFrame& frame, const HatchingParameters& p);
  void show(const scene::ArFrame& frame, const HatchingParameters& p, std::string_view name);
};

void Hatching::State::take(const scene::ArFrame& frame, const HatchingParameters& p) {
  canvas = nullptr;
  const DrawingPlan plan = drawingPlanOf(p, frame.full());
  if (drawing == nullptr || drawing->full != frame.full() || drawing->plan != plan) {
    if (drawing != nullptr && drawing->full != frame.full()) {
      canvases.clear();
      tone.clear();
    }
    drawing.reset();
    drawing = std::make_unique<Drawing>(library, frame.full(), plan);
  }
  canvas = &canvases.of(frame.size(), frame.size());
}

void Hatching::State::follow(const scene::ArFrame& frame, const HatchingParameters& p) {
  drawing->motion.update(frame);
  if (p.movers) {
    drawing->movers.update(frame, drawing->motion);
    if (const auto cover = drawing->movers.cover()) hiding.hide(frame, *cover);
  } else {
    drawing->movers.reset();
  }
  // Lines are long: led by weak edges, they would cross.
  drawing->field.update(frame, *frame.colour, drawing->motion,
                        {.maxLeading = marks::kMaxDetailUnit}, moversOf(p));
  if (p.filterTimeSeconds > 0.0) {
    filtered.update(frame, {.backward = &drawing->motion.backward(),
                            .isCut = drawing->motion.isCut(),
                            .timeConstantSeconds = p.filterTimeSeconds,
                            .noiseLevels = drawing->motion.noiseLevels()});
    source = &filtered.picture();
  } else {
    filtered.reset();
    source = frame.colour;
  }
  tone.update(frame, {.source = source,
                      .movers = moversOf(p),
                      .isCut = drawing->motion.isCut(),
                      .lighten = p.lighten});
}

void Hatching::State::findContours(const scene::ArFrame& frame, const HatchingParameters& p) {
  const marks::TensorField& field = drawing->field;
  const hal::FrameSize regions = field.resolved(0).size();
  const glm::vec2 fieldScale(1.0 /
                             (field.regionPixels(0) * glm::dvec2(regions.width, regions.height)));
  const auto step = std::max(
      kMinContourStep,
      static_cast<float>(p.contourWidth * hatchScale(frame.full()) * frame.pixelsOfFull().x));
  const marks::FidelityField fidelity = fidelityOf(p, frame);
  const auto bindField = [&](gpu::Program& pass) {
    pass.texture("field", field.resolved(0))
        .texture("modelField", field.resolvedModels(0))
        .texture("forms", frame.hasObjects ? *frame.forms : noIds)
        .set("hasForms", frame.hasObjects ? 1 : 0)
        .texture("moverField", field.movers())
        .texture("movers", layerTextures.labelsOf(moversOf(p)))
        .set("fieldScale", fieldScale)
        .set("size", glm::vec2(canvas->size.width, canvas->size.height))
        .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
        .set("step_", step);
    fidelity.bind(pass);
  };
  bindField(contourEdges.use());
  contourEdges.texture("luma", tone.luma()).drawFullscreen(canvas->edgesTarget);
  gpu::Program& pass = frame.hasObjects ? contourLinesOfModels : contourLines;
  bindField(pass.use());
  pass.texture("edges", canvas->edges)
      .texture("picture", *source)
      .texture("background", layerTextures.backgroundOf(moversOf(p)))
      .set("threshold", static_cast<float>(p.contourThreshold))
      .set("sign_", p.inverted ? 1.0F : -1.0F);
  if (frame.hasObjects) {
    pass.texture("ids", *frame.ids).texture("normalFocus", *frame.normalFocus);
  }
  pass.drawFullscreen(canvas->contoursTarget);
}

void Hatching::State::drawLines(const scene::ArFrame& frame, const HatchingParameters& p,
                                std::string_view name) {
  for (std::size_t i = 0; i < drawing->sets.size(); ++i) {
    HatchRule rule = hatchRuleOf(p, frame, i);
    if (!name.empty()) rule.paint = glm::vec4(kSetColours.at(i), 1.0F);
    if (!name.empty()) rule.colour = 0.0F;
    if (name == "ranks") rule.rankColour = 1.0F;
    drawing->sets[i]->update(frame,
                             {.motion = &drawing->motion,
                              .field = &drawing->field,
                              .tone = &tone.tone(),
                              .movers = moversOf(p),
                              .colours = source},
                             rule);
  }
  const bool isClipped = frame.hasObjects || p.movers;
  if (isClipped) borders.draw(frame, moversOf(p), canvas->bordersTarget);
  canvas->inkTarget.beginDiscarding();
  canvas->inkTarget.clearColour(0, glm::vec4(0.0F));
  const bool mayBePlain = !frame.hasObjects;  // as HatchLines lays them out
  for (const auto& set : drawing->sets) {
    if (mayBePlain) drawPart(StripPart::kPlain, false, frame, p, set->strips());
    if (isClipped) drawPart(StripPart::kClipped, true, frame, p, set->strips());
    drawPart(StripPart::kCarried, isClipped, frame, p, set->strips());
  }
}

void Hatching::State::drawPart(StripPart part, bool isClipped, const scene::ArFrame& frame,
                               const HatchingParameters& p, const StrokeStrips& laid) {
  const bool hasGrain = p.grain > 0.0;
  LinePrograms& programs = hasGrain ? grainyLines : lines;
  gpu::Program& program = isClipped ? programs.clipped : programs.plain;
  program.use()
      .set("scale", static_cast<float>(frame.pixelsOfFull().x))
      .set("fullSize", glm::vec2(frame.full().width, frame.full().height));
  if (hasGrain) {
    program.texture("brushes", brushes.brush(p.brush, kBrushTexelsAcross))
        .set("grain", static_cast<float>(p.grain));
  }
  if (isClipped) program.texture("borders", canvas->borders);
  strips.draw(program, laid, part, canvas->inkTarget);
}

void Hatching::State::finish(const scene::ArFrame& frame, const HatchingParameters& p) {
  paper.bind(compose.use(), frame);
  compose.texture("ink", canvas->ink)
      .texture("contours", canvas->contours)
      .texture("frame", *frame.colour)
      .texture("normalFocus", frame.hasFocus ? *frame.normalFocus : *frame.colour)
      .set("hasFocus", frame.hasFocus ? 1 : 0)
      .set("contourWeight", static_cast<float>(p.contours))
      .set("lift", static_cast<float>(p.lift))
      .set("inkColour", inkColourOf(p))
      .texture("colours", *source)
      .set("colour", static_cast<float>(p.colour))
      .set("paperColour", glm::vec3(p.paperRed, p.paperGreen, p.paperBlue))
      .set("tooth", static_cast<float>(p.tooth))
      .texture("movers", layerTextures.labelsOf(moversOf(p)))
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .set("relief", static_cast<float>(p.relief))
      .drawFullscreen(canvas->pictureTarget);
}

void Hatching::State::show(const scene::ArFrame& frame, const HatchingParameters& p,
                           std::string_view name) {
  view.use()
      .texture("ink", canvas->ink)
      .texture("contours", canvas->contours)
      .texture("edges", canvas->edges)
      .set("view", static_cast<int>(viewIndex(kViews, name)))
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()));
  bindHatchTone(view, frame, tone.tone(), hatchRuleOf(p, frame, 0));
  view.drawFullscreen(canvas->pictureTarget);
}

const StyleKind& hatchingKind() {
  static const StyleKind kKind{
      .name = "hatching",
      .help = "tone by lines of ink that cross in the darks, and contours",
      .defaults = hatchingParameters().defaults(),
      .looks = hatchingLooks(),
      .views = kViews,
      .needs = {.surfaces = true,
                .measuredMotion = true,
                .faces = true,
                .canvas = true,
                .shading = scene::Shading::kSmooth},
      .coherence = {.gates = kGates, .paperLooks = kPaperLooks, .drawsLines = true},
      .shaders = {gpu::hatchingShaders(), gpu::strokesShaders(), gpu::substrateShaders()},
      .check =
          [](const config::ParameterValues& values) {
            return checkBrushFile(hatchingParameters().typed(values).brushFile);
          },
      .make = [](const gpu::ShaderLibrary& library, SceneContents contents)
          -> std::unique_ptr<Style> { return std::make_unique<Hatching>(library, contents); }};
  return kKind;
}

Hatching::Hatching(const gpu::ShaderLibrary& library, SceneContents contents)
    : values_(hatchingParameters().defaults()), state_(std::make_unique<State>(library)) {
  warmUp(contents);
}

Hatching::~Hatching() = default;

/// A program's real cost on software renderers is at its first use: here, not in the first frame
/// that shows a model, has a focus or is looked at in another way.
void Hatching::warmUp(SceneContents contents) {
  constexpr hal::FrameSize kSize{16, 16};
  const std::vector<std::uint8_t> zeros(std::size_t{16} * 16 * 4);
  Texture grey(TextureFormat::kRgba8, kSize, TextureFilter::kLinear);
  grey.upload(zeros, std::size_t{16} * 4);
  Texture ids(TextureFormat::kR32ui, kSize);
  ids.upload(zeros, std::size_t{16} * 4);
  scene::ArFrame frame{
      .colour = &grey, .ids = &ids, .normalFocus = &grey, .barycentrics = &ids, .forms = &ids};
  const bool hasModels = contents == SceneContents::kModels;
  frame.sceneHasModels = hasModels;
  paint(frame, kViews.front().name);
  for (const bool hasMore : {true, false}) {
    p_.movers = hasMore;
    frame.hasObjects = frame.hasFocus = hasMore && hasModels;
    ++frame.sequence;
    paint(frame, {});
  }
  const StrokeStrips blank = StrokeStrips::blank();
  for (const double grain : {1.0, 0.0}) {
    p_.grain = grain;
    for (const bool isClipped : {true, false}) {
      state_->drawPart(StripPart::kPlain, isClipped, frame, p_, blank);
    }
  }
  if (hasModels) state_->hiding.warmUp();
  p_ = hatchingParameters().typed(values_);
  state_->drawing.reset();
  state_->filtered.reset();
  state_->canvas = nullptr;
  state_->canvases.clear();
  state_->tone.clear();
}

scene::ArFrameNeeds Hatching::needs() const {
  scene::ArFrameNeeds needs = kind().needs;
  needs.faces = p_.faces > 0.0;
  return needs;
}

hal::Result<void> Hatching::prepare(const config::ParameterValues& values) {
  return state_->brushes.take(hatchingParameters().typed(values).brushFile);
}

void Hatching::setParameters(const config::ParameterValues& values) {
  if (values == values_) return;
  p_ = hatchingParameters().typed(values);
  values_ = values;
}

const Texture& Hatching::paint(const scene::ArFrame& frame, std::string_view view) {
  State& s = *state_;
  s.take(frame, p_);
  s.follow(frame, p_);
  s.findContours(frame, p_);
  s.drawLines(frame, p_, view);
  if (view.empty()) {
    s.finish(frame, p_);
  } else {
    s.show(frame, p_, view);
  }
  return s.canvas->picture;
}

const marks::AnchorSet* Hatching::anchors() const {
  return state_->drawing ? &state_->drawing->sets.front()->anchors() : nullptr;
}

std::vector<marks::Anchor> Hatching::readAnchors() const {
  std::vector<marks::Anchor> all;
  for (std::size_t i = 0; i < setCount(); ++i) {
    const std::vector<marks::Anchor> some = set(i).anchors().read();
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

const marks::MotionLayers* Hatching::movers() const {
  return state_->drawing && p_.movers ? &state_->drawing->movers : nullptr;
}

std::size_t Hatching::setCount() const {
  return state_->drawing ? state_->drawing->sets.size() : 0;
}

const HatchLines& Hatching::set(std::size_t number) const {
  return *state_->drawing->sets.at(number);
}

const Texture& Hatching::ink() const {
  return state_->canvas->ink;
}

void Hatching::reset() {
  state_->filtered.reset();
  if (!state_->drawing) return;
  state_->drawing->motion.reset();
  state_->drawing->movers.reset();
  state_->drawing->field.reset();
  for (const auto& set : state_->drawing->sets) set->reset();
}

}  // namespace pleinair::styles
