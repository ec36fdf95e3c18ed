#include "pipeline/styles/watercolor/watercolor.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <span>
#include <string>
#include <utility>

#include "pipeline/gpu/images/pixel_block.h"
#include "pipeline/marks/fading_past.h"
#include "pipeline/marks/filtered_frame.h"
#include "pipeline/marks/motion_field.h"
#include "pipeline/marks/movers/motion_layers.h"
#include "pipeline/scene/render/model_hiding.h"
#include "pipeline/styles/substrate/substrate.h"
#include "pipeline/styles/substrate/substrate_shaders.h"
#include "pipeline/styles/watercolor/watercolor_shaders.h"

namespace pleinair::styles {
namespace {

using gpu::ImageAccess;
using gpu::Texture;
using gpu::TextureFilter;
using gpu::TextureFormat;

constexpr GLbitfield kWritten = GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                                GL_SHADER_IMAGE_ACCESS_BARRIER_BIT;
const std::string kShaders = "pipeline/styles/watercolor/shaders/";

constexpr std::string_view kMeansView = "means";
constexpr std::string_view kFilteredView = "filtered";
/// view.frag gets each one's number as VIEW_NAME.
constexpr std::array<DebugViewInfo, 10> kViews{{
    {"seeds", "the cells' seeds over the frame"},
    {"cells", "the Voronoi cells, each in a colour of its own, with their seeds"},
    {"anchors",
     "the cells in the colours of what their anchors' motion was taken from (orange a model, "
     "violet a plane, blue the whole picture, teal features, red flow, green stillness), "
     "pale while they are young"},
    {kMeansView, "each cell in its mean colour: the thesis's tiling"},
    {"edges", "edge pixels black, weaker colour differences grey"},
    {"retiling",
     "edge pixels, and each seed's way from its anchor to where it was drawn; red: on it"},
    {kFilteredView,
     "the picture averaged along its motion, which edges and colours are taken from"},
    {"dark", "the dark washes, before it is decided where they lie"},
    {"light", "the light washes"},
    {"paper", "the substrate of paper"},
}};

/// The limits that its paintings are held to (docs/measuring.md).
constexpr std::array kGates{
    CoherenceGate{CoherenceMeasure::kNHw2, CoherenceGate::Side::kMax, 0.30},
    CoherenceGate{CoherenceMeasure::kXFlk, CoherenceGate::Side::kMax, 0.15},
    CoherenceGate{CoherenceMeasure::kDep, CoherenceGate::Side::kMin, 0.75, true},
    CoherenceGate{CoherenceMeasure::kScr, CoherenceGate::Side::kMax, 0.3, true,
                  GateMotion::kMoving},
};

/// Where the palette of a place is taken from (pigment.frag): x and y in radii of a disc, and the
/// weight: the middle, six places around it, six further out between them.
constexpr std::array<glm::vec4, 13> kPaletteTaps{{{0.0F, 0.0F, 1.2F, 0.0F},
                                                  {0.52F, 0.0F, 1.0F, 0.0F},
                                                  {0.26F, 0.45F, 1.0F, 0.0F},
                                                  {-0.26F, 0.45F, 1.0F, 0.0F},
                                                  {-0.52F, 0.0F, 1.0F, 0.0F},
                                                  {-0.26F, -0.45F, 1.0F, 0.0F},
                                                  {0.26F, -0.45F, 1.0F, 0.0F},
                                                  {0.83F, 0.48F, 0.55F, 0.0F},
                                                  {0.0F, 0.96F, 0.55F, 0.0F},
                                                  {-0.83F, 0.48F, 0.55F, 0.0F},
                                                  {-0.83F, -0.48F, 0.55F, 0.0F},
                                                  {0.0F, -0.96F, 0.55F, 0.0F},
                                                  {0.83F, -0.48F, 0.55F, 0.0F}}};

/// One anchor a cell in the mean. Squares of two cells a side have enough of them for births and
/// deaths to be rare: three of four must be gone, or half as many again be there.
marks::AnchorOptions anchorOptions(const WatercolorParameters& p) {
  return {.density = {.cellPixels = 2 * p.cellSizePixels,
                      .target = 4,
                      .birthBelow = 2,
                      .deathAbove = 6},
          .seed = static_cast<unsigned>(p.seed)};
}

}  // namespace

struct Watercolor::Passes {
  explicit Passes(const gpu::ShaderLibrary& library)
      : hiding(library),
        filtered(library),
        tiler(library),
        gliding(library.fragmentPass(kShaders + "gliding.frag")),
        guide(library.fragmentPass(kShaders + "guide.frag", {}, {TextureFormat::kRgba8})),
        split(library.compute(kShaders + "split.comp")),
        washes(library.compute(kShaders + "washes.comp")),
        pigment(library.fragmentPass(kShaders + "pigment.frag", {},
                                     {TextureFormat::kRgba8, TextureFormat::kRgba8})),
        layers(library.fragmentPass(kShaders + "layers.frag")),
        compose(library.fragmentPass(kShaders + "compose.frag", {}, {TextureFormat::kRgba8})),
        composeMore(
            library.fragmentPass(kShaders + "compose.frag", {{"MOSAIC"}}, {TextureFormat::kRgba8})),
        showSeeds(library.compute(kShaders + "show_seeds.comp")),
        view(library.fragmentPass(kShaders + "view.frag", viewDefines(kViews))),
        substrate(library, Substrate::Kind::kPaper),
        paletteTaps(gpu::Buffer::of(std::span<const glm::vec4>(kPaletteTaps))) {}

  scene::ModelHiding hiding;
  marks::FilteredFrame filtered;
  CellTiling tiler;
  gpu::Program gliding;
  gpu::Program guide;
  gpu::Program split;
  gpu::Program washes;
  gpu::Program pigment;
  gpu::Program layers;
  gpu::Program compose;
  gpu::Program composeMore;
  gpu::Program showSeeds;
  gpu::Program view;
  Substrate substrate;
  gpu::Buffer paletteTaps;
};

/// The state that belongs to one full size.
struct Watercolor::Marks {
  Marks(const gpu::ShaderLibrary& library, hal::FrameSize fullSize)
      : full(fullSize),
        field(library, full),
        movers(library, full),
        gliding(field.backward().size()) {}

  hal::FrameSize full;
  marks::MotionField field;
  marks::MotionLayers movers;
  WatercolorGliding gliding;
  std::unique_ptr<marks::AnchorSet> anchors;  // of one cell size and seed
  std::unique_ptr<WatercolorCells> cells;
  int cellSize = 0;
  int seed = 0;
};

Watercolor::Watercolor(const gpu::ShaderLibrary& library, SceneContents contents)
    : library_(&library),
      values_(watercolorParameters().defaults()),
      passes_(std::make_unique<Passes>(library)) {
  warmUp(contents);
}

Watercolor::~Watercolor() = default;

const StyleKind& watercolorKind() {
  static const StyleKind kKind{.name = "watercolor",
                               .help = "washes of pigment on paper (thesis chapter III, and on)",
                               .defaults = watercolorParameters().defaults(),
                               .looks = watercolorLooks(),
                               .views = kViews,
                               .needs = {.surfaces = true, .measuredMotion = true, .canvas = true},
                               .coherence = {.gates = kGates},
                               .shaders = {gpu::watercolorShaders(), gpu::substrateShaders()},
                               .make = [](const gpu::ShaderLibrary& library,
                                          SceneContents contents) -> std::unique_ptr<Style> {
                                 return std::make_unique<Watercolor>(library, contents);
                               }};
  return kKind;
}

void Watercolor::setParameters(const config::ParameterValues& values) {
  p_ = watercolorParameters().typed(values);
  values_ = values;
}

void Watercolor::reset() {
  hasPast_ = false;
  passes_->filtered.reset();
  if (marks_ == nullptr) return;
  marks_->field.reset();
  marks_->movers.reset();
  if (marks_->anchors != nullptr) marks_->anchors->reset();
}

const marks::AnchorSet* Watercolor::anchors() const {
  return marks_ == nullptr ? nullptr : marks_->anchors.get();
}

std::vector<marks::Anchor> Watercolor::readAnchors() const {
  const marks::AnchorSet* set = anchors();
  return set == nullptr ? std::vector<marks::Anchor>{} : set->read();
}

Watercolor::Inner Watercolor::inner() const {
  assert(canvas_ != nullptr);
  return {.tiler = &passes_->tiler,
          .tiling = &canvas_->tiling,
          .filtered = picture_,
          .guide = &canvas_->guide,
          .darkWash = &marks_->cells->darkWash,
          .lightWash = &marks_->cells->lightWash};
}

const Texture& Watercolor::paint(const scene::ArFrame& frame, std::string_view view) {
  takeMarks(frame);
  takeCanvas(frame);
  step_ = hasPast_ ? marks::timeStep(lastTime_, frame.captureTime) : hal::Duration(0);
  marks_->field.update(frame);
  findMovers(frame);
  marks_->anchors->advance(frame, marks_->field, {}, movers());
  filtered(frame);
  tile(frame, p_.mosaic > 0.0 || view == kMeansView);
  findGliding();
  paintWashes(frame);
  lastTime_ = frame.captureTime;
  hasPast_ = true;
  if (view.empty()) {
    compose(frame);
  } else {
    showView(frame, view);
  }
  previousCanvas_ = canvas_;
  return canvas_->picture;
}

/// Tells movers apart, and hides the models that they are before.
void Watercolor::findMovers(const scene::ArFrame& frame) {
  marks::MotionLayers& movers = marks_->movers;
  if (!p_.movers) {
    movers.reset();
    return;
  }
  movers.update(frame, marks_->field);
  if (const auto cover = movers.cover()) passes_->hiding.hide(frame, *cover);
}

/// Null where movers are not told apart.
const marks::MotionLayers* Watercolor::movers() const {
  return marks_ != nullptr && p_.movers ? &marks_->movers : nullptr;
}

/// Anchors and cells for this frame's full size, and the parameters that they are made by.
void Watercolor::takeMarks(const scene::ArFrame& frame) {
  if (marks_ == nullptr || marks_->full != frame.full()) {
    hasPast_ = false;  // where there is no memory for the new ones, nothing is left half made
    canvas_ = previousCanvas_ = nullptr;
    canvases_.clear();
    marks_.reset();
    marks_ = std::make_unique<Marks>(*library_, frame.full());
  }
  Marks& m = *marks_;
  if (m.anchors != nullptr && m.cellSize == p_.cellSizePixels && m.seed == p_.seed) return;
  m.anchors.reset();
  m.cells.reset();
  m.cellSize = p_.cellSizePixels;
  m.seed = p_.seed;
  auto anchors = std::make_unique<marks::AnchorSet>(*library_, m.full, anchorOptions(p_));
  m.cells = std::make_unique<WatercolorCells>(anchors->slotCount());
  passes_->tiler.allocate(m.full, m.cellSize, anchors->slotCount());
  m.anchors = std::move(anchors);
}

/// The canvas of this frame's size; those of other sizes stay, for levels of quality.
void Watercolor::takeCanvas(const scene::ArFrame& frame) {
  canvas_ = nullptr;
  canvas_ = &canvases_.of(frame.size(), frame.size());
  pixelsOfFull_ = static_cast<float>(frame.pixelsOfFull().x);
}

/// Finds the image that edges and colours are taken from.
void Watercolor::filtered(const scene::ArFrame& frame) {
  picture_ = frame.colour;
  if (p_.filterTimeSeconds <= 0.0) {
    passes_->filtered.reset();
    return;
  }
  passes_->filtered.update(frame, {.backward = &marks_->field.backward(),
                                   .isCut = marks_->field.isCut(),
                                   .timeConstantSeconds = p_.filterTimeSeconds,
                                   .noiseLevels = marks_->field.noiseLevels()});
  picture_ = &passes_->filtered.picture();
}

void Watercolor::tile(const scene::ArFrame& frame, bool wantsMeans) {
  passes_->tiler.tile(
      {.frame = &frame,
       .picture = picture_,
       .movers = movers(),
       .tilingThen = previousCanvas_ != nullptr ? &previousCanvas_->tiling : nullptr,
       .tiling = &canvas_->tiling,
       .step = step_,
       .wantsMeans = wantsMeans},
      *marks_->anchors, p_);
}

/// Finds what moves over the paper.
void Watercolor::findGliding() {
  constexpr double kFadeSeconds = 0.12;
  constexpr float kReferenceWidth = 640.0F;
  WatercolorGliding& g = marks_->gliding;
  const marks::MotionField& field = marks_->field;
  const bool stands = field.isStanding() && step_ > hal::Duration(0);
  g.latest = 1 - g.latest;
  passes_->gliding.use()
      .texture("motion", field.backward())
      .texture("before", g.masks[1 - g.latest])
      .set("perSecond", stands ? static_cast<float>(1.0 / hal::toSeconds(step_)) : 0.0F)
      .set("kept", hasPast_ ? marks::keptAfter(step_, kFadeSeconds) : 0.0F)
      .set("fullByReference", static_cast<float>(marks_->full.width) / kReferenceWidth)
      .drawFullscreen(g.targets[g.latest]);
}

/// Turns the colours of the cells into two smooth layers of pigment.
void Watercolor::paintWashes(const scene::ArFrame& frame) {
  const WatercolorCanvas& s = *canvas_;
  const WatercolorCells& cells = *marks_->cells;
  passes_->guide.use()
      .texture("picture", *picture_)
      .set("texel", 1.0F / glm::vec2(s.size.width, s.size.height))
      .set("reach", static_cast<float>(p_.simplicity) * pixelsOfFull_)
      .set("vividness", static_cast<float>(p_.vividness))
      .set("luminosity", static_cast<float>(p_.luminosity))
      .drawFullscreen(s.guideTarget);
  mixWashes();
  passes_->substrate.bind(passes_->pigment.use(), frame);
  passes_->pigment.texture("tiling", s.tiling)
      .texture("darkWash", cells.darkWash)
      .texture("lightWash", cells.lightWash)
      .set("cellPixels", glm::vec2(static_cast<float>(marks_->cellSize) * pixelsOfFull_))
      .set("reach", static_cast<float>(p_.bleeding))
      .uniformBlock("Taps", passes_->paletteTaps, 0, passes_->paletteTaps.sizeBytes())
      .set("tapCount", static_cast<int>(kPaletteTaps.size()))
      .drawFullscreen(s.pigmentTarget);
  passes_->layers.use()
      .texture("guide", s.guide)
      .texture("darkPigment", s.darkPigment)
      .texture("lightPigment", s.lightPigment)
      .texture("gliding", marks_->gliding.now())
      .set("pixelsOfFull", pixelsOfFull_)
      .set("hardness", static_cast<float>(p_.hardness))
      .set("gaps", static_cast<float>(p_.gaps))
      .set("variation", static_cast<float>(p_.variation))
      .drawFullscreen(s.layersTarget);
}

/// The two colours of each cell, averaged over time.
void Watercolor::mixWashes() {
  const WatercolorCanvas& s = *canvas_;
  WatercolorCells& cells = *marks_->cells;
  passes_->split.use()
      .storage("Moments", cells.moments)
      .texture("guide", s.guide)
      .texture("tiling", s.tiling)
      .dispatch(gpu::pixelBlocksOf(s.guide.size()), kWritten);
  const bool hasPast = hasPast_ && !marks_->anchors->hasBegunAnew();
  passes_->washes.use()
      .storage("Moments", cells.moments)
      .storage("Seeds", passes_->tiler.seeds())
      .storage("Past", cells.averages[cells.latest])
      .storage("Now", cells.averages[1 - cells.latest])
      .image("darkWash", cells.darkWash, ImageAccess::kWrite)
      .image("lightWash", cells.lightWash, ImageAccess::kWrite)
      .set("slots", static_cast<int>(cells.slots))
      .set("kept", hasPast ? marks::keptAfter(step_, p_.colourTimeSeconds) : 0.0F)
      .dispatch({static_cast<int>(cells.slots), 1}, kWritten);
  cells.latest = 1 - cells.latest;
}

void Watercolor::compose(const scene::ArFrame& frame) {
  const WatercolorCanvas& s = *canvas_;
  const bool needsMore = frame.hasFocus || p_.mosaic > 0.0;
  gpu::Program& pass = needsMore ? passes_->composeMore : passes_->compose;
  passes_->substrate.bind(pass.use(), frame);
  pass.texture("tiling", s.tiling)
      .texture("darkLayer", s.darkLayer)
      .texture("lightLayer", s.lightLayer)
      .texture("gliding", marks_->gliding.now())
      .set("pictureSize", glm::vec2(s.size.width, s.size.height))
      .set("threshold", static_cast<float>(p_.edgeThreshold))
      .set("edgeSoftness", static_cast<float>(p_.edgeSoftness))
      .set("edgeDarkness", static_cast<float>(p_.edgeDarkness) * pixelsOfFull_)  // wider lines
      .set("wobble", static_cast<float>(p_.wobble) * pixelsOfFull_)
      .set("rim", static_cast<float>(p_.rim))
      .set("granulation", static_cast<float>(p_.granulation))
      .set("grain", static_cast<float>(p_.grain));
  if (needsMore) {
    pass.texture("means", passes_->tiler.means())
        .texture("frame", *frame.colour)
        .texture("normalFocus", frame.hasFocus ? *frame.normalFocus : *frame.colour)
        .set("hasFocus", frame.hasFocus ? 1 : 0)
        .set("vividness", static_cast<float>(p_.vividness))
        .set("luminosity", static_cast<float>(p_.luminosity))
        .set("mosaic", static_cast<float>(p_.mosaic));
  }
  pass.drawFullscreen(s.pictureTarget);
}

void Watercolor::showView(const scene::ArFrame& frame, std::string_view view) {
  const WatercolorCanvas& s = *canvas_;
  const WatercolorCells& cells = *marks_->cells;
  passes_->showSeeds.use()
      .storage("Anchors", marks_->anchors->anchors())
      .storage("Seeds", passes_->tiler.seeds())
      .storage("Points", passes_->tiler.points())
      .image("places", cells.places, ImageAccess::kWrite)
      .image("ways", cells.ways, ImageAccess::kWrite)
      .set("slots", static_cast<int>(cells.slots))
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .dispatch({static_cast<int>(cells.slots), 1}, kWritten);
  passes_->view.use()
      .texture("tiling", s.tiling)
      .texture("means", passes_->tiler.means())
      .texture("places", cells.places)
      .texture("ways", cells.ways)
      .texture("darkPigment", s.darkPigment)
      .texture("lightPigment", s.lightPigment)
      .texture("paper", passes_->substrate.tile())
      .texture("picture", view == kFilteredView ? *picture_ : *frame.colour)
      .set("view", static_cast<int>(viewIndex(kViews, view)))
      .set("pictureSize", glm::vec2(s.size.width, s.size.height))
      .drawFullscreen(s.pictureTarget);
}

/// A program's real cost on software renderers is at its first use: here, not in the first frame.
void Watercolor::warmUp(SceneContents contents) {
  Texture grey(TextureFormat::kRgba8, {16, 16}, TextureFilter::kLinear);
  grey.upload(std::array<std::uint8_t, std::size_t{16} * 16 * 4>{}, std::size_t{16} * 4);
  Texture ids(TextureFormat::kR32ui, grey.size());
  ids.upload(std::array<std::uint8_t, std::size_t{16} * 16 * 4>{}, std::size_t{16} * 4);
  const bool hasModels = contents == SceneContents::kModels;
  scene::ArFrame frame{.colour = &grey,
                       .ids = &ids,
                       .normalFocus = &grey,
                       .barycentrics = &ids,
                       .forms = &ids,
                       .sceneHasModels = hasModels};
  paint(frame, "");
  ++frame.sequence;
  paint(frame, kViews.front().name);
  frame.hasFocus = true;  // as for the look "mosaic"
  ++frame.sequence;
  paint(frame, "");
  frame.hasFocus = false;
  if (hasModels) {
    frame.hasObjects = true;
    ++frame.sequence;
    paint(frame, "");
    passes_->hiding.warmUp();
  }
  canvas_ = previousCanvas_ = nullptr;
  canvases_.clear();
  marks_.reset();
  reset();
}

}  // namespace pleinair::styles
