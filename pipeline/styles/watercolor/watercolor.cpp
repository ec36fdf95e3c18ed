#include "pipeline/styles/watercolor/watercolor.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace pleinair::styles {
namespace {

using gpu::ImageAccess;
using gpu::Texture;
using gpu::TextureFilter;
using gpu::TextureFormat;

constexpr int kPaperPixels = 512;  // as in paper.frag
/// What the next pass reads, and what the next round writes over.
constexpr GLbitfield kWritten = GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                                GL_SHADER_IMAGE_ACCESS_BARRIER_BIT;
constexpr int kSettlingRounds = 3;
constexpr int kBlockPixels = 4;  // as in tile.comp
const std::string kShaders = "pipeline/styles/watercolor/shaders/";

constexpr std::string_view kMeansView = "means";
/// In the order of view.frag.
constexpr std::array<ViewInfo, 8> kViews{{
    {"seeds", "the cells' seeds over the frame"},
    {"cells", "the Voronoi cells, each in a colour of its own, with their seeds"},
    {kMeansView, "each cell in its mean colour: the thesis's tiling"},
    {"edges", "edge pixels black, weaker colour differences grey"},
    {"retiling", "edge pixels, and each seed's way from home to where it was drawn"},
    {"dark", "the dark washes, before it is decided where they lie"},
    {"light", "the light washes"},
    {"paper", "the sheet of paper"},
}};

/// Where a pixel lies on the paper, which goes with the picture as a whole. The paper keeps its
/// grain's size on the screen under any zoom: two octaves of it blend into each other.
struct PaperPlace {
  glm::vec2 linear;  // of the finer octave: complex, paper px a picture px
  glm::vec2 shift;   // paper px
  float coarser;     // how much of the coarser octave is seen
};

PaperPlace paperPlace(const scene::ArFrame& frame) {
  const tracking::PlaneSimilarity& canvasFromPicture = frame.canvasFromPicture;
  // The blend takes the middle of an octave; elsewhere one octave is enough, and half the reads.
  constexpr double kBlendFrom = 0.3;
  constexpr double kBlendTo = 0.7;
  const double octave = std::log2(canvasFromPicture.scale());
  double whole = std::floor(octave + 1e-6);
  const double part = octave - whole;
  double coarser = std::max(0.0, (part - kBlendFrom) / (kBlendTo - kBlendFrom));
  if (coarser >= 1.0) {
    whole += 1.0;
    coarser = 0.0;
  }
  const double finer = std::exp2(-whole);
  // The lowest frequency that is read is an eighth's (pigment.frag, and its coarser octave).
  const double period = 8.0 * kPaperPixels;
  const glm::dvec2 shift = canvasFromPicture.shift * finer;
  return {.linear = canvasFromPicture.linear * finer / frame.pixelsOfFull().x,
          .shift = shift - period * glm::floor(shift / period),
          .coarser = static_cast<float>(coarser)};
}

/// An edge in a cell has the fewer pixels the smaller the picture is.
unsigned minEdgePixels(int ofFull, float pixelsOfFull) {
  return static_cast<unsigned>(
      std::max(1L, std::lround(pixelsOfFull * static_cast<float>(ofFull))));
}

/// The share of its way that something with this time constant goes in `step`.
float shareOf(hal::Duration step, double timeConstantSeconds) {
  const double seconds = std::chrono::duration<double>(step).count();
  return static_cast<float>(1.0 - std::exp(-seconds / timeConstantSeconds));
}

}  // namespace

struct Watercolor::Passes {
  explicit Passes(const gpu::ShaderLibrary& library)
      : seedHome(library.compute(kShaders + "seed_home.comp")),
        seedScale(library.compute(kShaders + "seed_scale.comp")),
        tile(library.compute(kShaders + "tile.comp")),
        cells(library.compute(kShaders + "cells.comp")),
        guide(library.fragmentPass(kShaders + "guide.frag")),
        split(library.compute(kShaders + "split.comp")),
        washes(library.compute(kShaders + "washes.comp")),
        pigment(library.fragmentPass(kShaders + "pigment.frag")),
        layers(library.fragmentPass(kShaders + "layers.frag")),
        compose(library.fragmentPass(kShaders + "compose.frag")),
        composeMore(library.fragmentPass(kShaders + "compose_more.frag")),
        view(library.fragmentPass(kShaders + "view.frag")),
        paper(library.fragmentPass(kShaders + "paper.frag")) {}

  gpu::Program seedHome;
  gpu::Program seedScale;
  gpu::Program tile;
  gpu::Program cells;
  gpu::Program guide;
  gpu::Program split;
  gpu::Program washes;
  gpu::Program pigment;
  gpu::Program layers;
  gpu::Program compose;
  gpu::Program composeMore;
  gpu::Program view;
  gpu::Program paper;
};

Watercolor::Watercolor(const gpu::ShaderLibrary& library)
    : values_(watercolorParameters().defaults()), passes_(std::make_unique<Passes>(library)) {
  makePaper();
  warmUp();
}

Watercolor::~Watercolor() = default;

std::span<const ViewInfo> watercolorViews() {
  return kViews;
}

void Watercolor::setParameters(const config::ParameterValues& values) {
  p_ = watercolorParameters().typed(values);
  values_ = values;
}

void Watercolor::reset() {
  hasPast_ = false;
}

Watercolor::Inner Watercolor::inner() const {
  assert(canvas_ != nullptr);
  return {.seeds = &cells_->seeds,
          .tiling = &canvas_->tiling,
          .means = &cells_->means,
          .guide = &canvas_->guide,
          .darkWash = &cells_->darkWash,
          .lightWash = &cells_->lightWash};
}

const Texture& Watercolor::paint(const scene::ArFrame& frame, std::string_view view,
                                 gpu::PassTimer& timer) {
  const bool isFirst = needsNewTiling(frame);
  const hal::FrameSize before = canvas_ == nullptr ? frame.size() : canvas_->size;
  takeCanvas(frame);
  if (isFirst) {
    startTiling(frame);
    for (int i = 0; i < kSettlingRounds; ++i) tileAndRetile(frame, timer, true, false);
  } else if (before != frame.size()) {
    scaleSeeds(before);
  }
  const bool wantsMeans = p_.mosaic > 0.0 || view == kMeansView;
  tileAndRetile(frame, timer, false, wantsMeans);
  paintWashes(frame, timer);
  lastTime_ = frame.captureTime;
  hasPast_ = true;
  if (view.empty()) {
    compose(frame, timer);
  } else {
    showView(frame, view);
  }
  return canvas_->picture;
}

bool Watercolor::needsNewTiling(const scene::ArFrame& frame) const {
  return !hasPast_ || canvas_ == nullptr || cells_->full != frame.full() ||
         cells_->cellSize != p_.cellSizePixels || seed_ != static_cast<unsigned>(p_.seed);
}

/// Cells and canvas of this frame's size; those of other sizes stay, for levels of quality.
void Watercolor::takeCanvas(const scene::ArFrame& frame) {
  canvas_ = nullptr;  // where there is no memory for the new ones, nothing is left half made
  if (cells_ == nullptr || cells_->full != frame.full() || cells_->cellSize != p_.cellSizePixels) {
    if (cells_ != nullptr && cells_->full != frame.full()) canvases_.clear();
    cells_.reset();
    cells_ = std::make_unique<WatercolorCells>(frame.full(), p_.cellSizePixels);
  }
  const auto isOfSize = [&](const auto& each) { return each->size == frame.size(); };
  const auto known = std::ranges::find_if(canvases_, isOfSize);
  canvas_ = known != canvases_.end()
                ? known->get()
                : canvases_.emplace_back(std::make_unique<WatercolorCanvas>(frame.size())).get();
  cellPixels_ = cells_->grid.cellPixels(frame.size());
  pixelsOfFull_ = static_cast<float>(frame.pixelsOfFull().x);
}

void Watercolor::startTiling(const scene::ArFrame& frame) {
  seed_ = static_cast<unsigned>(p_.seed);
  passes_->seedHome.use()
      .storage(0, cells_->seeds)
      .storage(1, cells_->sums)
      .storage(2, cells_->moments)
      .set("grid", cells_->grid.cells())
      .set("cellPixels", cellPixels_)
      .set("seed", seed_)
      .dispatch(cells_->grid.cells(), {8, 8}, GL_SHADER_STORAGE_BARRIER_BIT);
  lastTime_ = frame.captureTime;
}

void Watercolor::scaleSeeds(hal::FrameSize from) {
  passes_->seedScale.use()
      .storage(0, cells_->seeds)
      .set("grid", cells_->grid.cells())
      .set("cellPixels", cellPixels_)
      .set("seed", seed_)
      .set("newPixels", glm::vec2(canvas_->size.width, canvas_->size.height) /
                            glm::vec2(from.width, from.height))
      .dispatch(cells_->grid.cells(), {8, 8}, GL_SHADER_STORAGE_BARRIER_BIT);
}

/// `atOnce`: seeds go all the way to their edges, whatever the time constants.
void Watercolor::tileAndRetile(const scene::ArFrame& frame, gpu::PassTimer& timer, bool atOnce,
                               bool wantsMeans) {
  const WatercolorCanvas& s = *canvas_;
  const WatercolorCells& cells = *cells_;
  {
    const auto scope = timer.measure("watercolor: tile");
    passes_->tile.use()
        .storage(0, cells.seeds)
        .storage(1, cells.sums)
        .image(0, s.tiling, ImageAccess::kWrite)
        .texture("picture", *frame.colour)
        .texture("ids", frame.hasObjects ? *frame.ids : s.tiling)
        .set("hasObjects", frame.hasObjects ? 1 : 0)
        .set("grid", cells.grid.cells())
        .set("cellPixels", cellPixels_)
        .set("alpha", static_cast<float>(p_.edgeAlpha))
        .set("beta", static_cast<float>(p_.edgeBeta))
        .set("threshold", static_cast<float>(p_.edgeThreshold))
        .set("wantsMeans", wantsMeans ? 1 : 0)
        .dispatch({(s.size.width + kBlockPixels - 1) / kBlockPixels,
                   (s.size.height + kBlockPixels - 1) / kBlockPixels},
                  {16, 4}, kWritten);
  }
  const hal::Duration step =
      std::clamp(frame.captureTime - lastTime_, hal::Duration(0), hal::Duration(1'000'000'000));
  const bool jump = atOnce || p_.retileTimeSeconds <= 0.0;
  const bool stay = atOnce || p_.returnTimeSeconds <= 0.0;
  const auto scope = timer.measure("watercolor: cells");
  passes_->cells.use()
      .storage(0, cells.seeds)
      .storage(1, cells.sums)
      .image(0, cells.means, ImageAccess::kWrite)
      .image(1, cells.shifts, ImageAccess::kWrite)
      .texture("picture", *frame.colour)
      .set("grid", cells.grid.cells())
      .set("cellPixels", cellPixels_)
      .set("seed", seed_)
      .set("minEdgePixels", minEdgePixels(p_.retilePixels, pixelsOfFull_))
      .set("follow", jump ? 1.0F : shareOf(step, p_.retileTimeSeconds))
      .set("drift", stay ? 0.0F : shareOf(step, p_.returnTimeSeconds))
      .dispatch(cells.grid.cells(), {8, 8}, kWritten);
}

/// What the cells hold of the picture becomes two smooth layers of pigment.
void Watercolor::paintWashes(const scene::ArFrame& frame, gpu::PassTimer& timer) {
  const WatercolorCanvas& s = *canvas_;
  const WatercolorCells& cells = *cells_;
  {
    const auto scope = timer.measure("watercolor: guide");
    passes_->guide.use()
        .texture("picture", *frame.colour)
        .set("texel", 1.0F / glm::vec2(s.size.width, s.size.height))
        .set("reach", static_cast<float>(p_.simplicity) * pixelsOfFull_)
        .set("vividness", static_cast<float>(p_.vividness))
        .set("luminosity", static_cast<float>(p_.luminosity))
        .drawFullscreen(s.guideTarget);
  }
  {
    const auto scope = timer.measure("watercolor: split");
    const hal::FrameSize half = s.guide.size();
    passes_->split.use()
        .storage(0, cells.moments)
        .texture("guide", s.guide)
        .texture("tiling", s.tiling)
        .set("grid", cells.grid.cells())
        .dispatch({(half.width + kBlockPixels - 1) / kBlockPixels,
                   (half.height + kBlockPixels - 1) / kBlockPixels},
                  {16, 4}, kWritten);
    passes_->washes.use()
        .storage(0, cells.moments)
        .image(0, cells.darkWash, ImageAccess::kWrite)
        .image(1, cells.lightWash, ImageAccess::kWrite)
        .texture("guide", s.guide)
        .set("grid", cells.grid.cells())
        .set("cellPixels", cellPixels_)
        .dispatch(cells.grid.cells(), {8, 8}, kWritten);
  }
  {
    const auto scope = timer.measure("watercolor: pigment");
    const PaperPlace place = paperPlace(frame);
    passes_->pigment.use()
        .texture("tiling", s.tiling)
        .texture("darkWash", cells.darkWash)
        .texture("lightWash", cells.lightWash)
        .set("cellPixels", cellPixels_)
        .texture("paper", paper_)
        .set("paperLinear", place.linear)
        .set("paperShift", place.shift)
        .set("coarser", place.coarser)
        .set("reach", static_cast<float>(p_.bleeding))
        .drawFullscreen(s.pigmentTarget);
  }
  const auto scope = timer.measure("watercolor: layers");
  passes_->layers.use()
      .texture("guide", s.guide)
      .texture("darkPigment", s.darkPigment)
      .texture("lightPigment", s.lightPigment)
      .set("pixelsOfFull", pixelsOfFull_)
      .set("hardness", static_cast<float>(p_.hardness))
      .set("gaps", static_cast<float>(p_.gaps))
      .set("variation", static_cast<float>(p_.variation))
      .drawFullscreen(s.layersTarget);
}

void Watercolor::compose(const scene::ArFrame& frame, gpu::PassTimer& timer) {
  const WatercolorCanvas& s = *canvas_;
  const WatercolorCells& cells = *cells_;
  const auto scope = timer.measure("watercolor: compose");
  const PaperPlace place = paperPlace(frame);
  const bool needsMore = frame.hasFocus || p_.mosaic > 0.0;
  gpu::Program& pass = needsMore ? passes_->composeMore : passes_->compose;
  pass.use()
      .texture("tiling", s.tiling)
      .texture("darkLayer", s.darkLayer)
      .texture("lightLayer", s.lightLayer)
      .texture("paper", paper_)
      .set("paperLinear", place.linear)
      .set("paperShift", place.shift)
      .set("coarser", place.coarser)
      .set("pictureSize", glm::vec2(s.size.width, s.size.height))
      .set("threshold", static_cast<float>(p_.edgeThreshold))
      .set("edgeSoftness", static_cast<float>(p_.edgeSoftness))
      .set("edgeDarkness", static_cast<float>(p_.edgeDarkness) * pixelsOfFull_)  // wider lines
      .set("wobble", static_cast<float>(p_.wobble) * pixelsOfFull_)
      .set("rim", static_cast<float>(p_.rim))
      .set("granulation", static_cast<float>(p_.granulation))
      .set("grain", static_cast<float>(p_.grain));
  if (needsMore) {
    pass.texture("means", cells.means)
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
  const auto* const found = std::ranges::find(kViews, view, &ViewInfo::name);
  assert(found != kViews.end());
  const WatercolorCanvas& s = *canvas_;
  const WatercolorCells& cells = *cells_;
  passes_->view.use()
      .texture("tiling", s.tiling)
      .texture("means", cells.means)
      .texture("shifts", cells.shifts)
      .texture("darkPigment", s.darkPigment)
      .texture("lightPigment", s.lightPigment)
      .texture("paper", paper_)
      .texture("picture", *frame.colour)
      .set("view", static_cast<int>(found - kViews.begin()))
      .set("cellPixels", cellPixels_)
      .set("pictureSize", glm::vec2(s.size.width, s.size.height))
      .set("seed", seed_)
      .drawFullscreen(s.pictureTarget);
}

void Watercolor::makePaper() {
  paper_ = Texture(TextureFormat::kRgba8, {kPaperPixels, kPaperPixels}, TextureFilter::kLinear,
                   gpu::TextureWrap::kRepeat);
  passes_->paper.use().drawFullscreen(gpu::RenderTarget({&paper_}));
}

/// A program's real cost on software renderers is at its first use: here, not in the first frame.
void Watercolor::warmUp() {
  Texture grey(TextureFormat::kRgba8, {16, 16}, TextureFilter::kLinear);
  grey.upload(std::array<std::uint8_t, std::size_t{16} * 16 * 4>{}, std::size_t{16} * 4);
  gpu::PassTimer timer;
  const scene::ArFrame frame{.colour = &grey};
  paint(frame, "", timer);
  paint({.colour = &grey, .normalFocus = &grey, .hasFocus = true}, "", timer);
  paint(frame, kViews.front().name, timer);
  scaleSeeds(grey.size());
  canvas_ = nullptr;
  canvases_.clear();
  cells_.reset();
  reset();
}

}  // namespace pleinair::styles
