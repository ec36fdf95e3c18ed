#include "pipeline/styles/painterly/painterly.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/gpu/program.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/marks/anchor_set.h"
#include "pipeline/marks/motion_field.h"
#include "pipeline/marks/stroke_set.h"
#include "pipeline/marks/tensor_field.h"
#include "pipeline/styles/painterly/coherence.h"
#include "pipeline/styles/painterly/layers.h"
#include "pipeline/styles/painterly/stroke_drawing.h"

namespace pleinair::styles {
namespace {

using gpu::Texture;
using gpu::TextureFilter;
using gpu::TextureFormat;

const std::string kShaders = "pipeline/styles/painterly/shaders/";
constexpr std::size_t kHalvings = 3;

constexpr std::string_view kTensorsView = "tensors";
constexpr std::string_view kPyramidView = "pyramid";
constexpr std::string_view kRegionsView = "regions";
constexpr std::string_view kLayersView = "layers";
constexpr std::string_view kSkeletonsView = "skeletons";
constexpr std::string_view kAnchorsView = "anchors";
constexpr std::string_view kHeightView = "height";
constexpr std::array<ViewInfo, 7> kViews{{
    {kTensorsView, "the tensor field: which way strokes go; blue from edges, red filled in"},
    {kPyramidView, "four levels of its pyramid"},
    {kRegionsView, "what is painted finely (red), middlingly (yellow) and broadly (blue)"},
    {kLayersView, "strokes in their layer's colour"},
    {kSkeletonsView, "the strokes' skeletons, likewise"},
    {kAnchorsView, "their anchors: red ones are young"},
    {kHeightView, "how thick the paint lies"},
}};
constexpr std::array<glm::vec3, kLayers> kLayerColours{
    {{0.3F, 0.45F, 0.8F}, {0.95F, 0.8F, 0.3F}, {0.9F, 0.3F, 0.2F}}};

Texture colours(hal::FrameSize size) {
  return {TextureFormat::kRgba8, size, TextureFilter::kLinear};
}

/// What is painted on, of pictures of one size.
struct Canvas {
  explicit Canvas(hal::FrameSize pictureSize)
      : size(pictureSize),
        colour(colours(size)),
        height(colours(size)),
        picture(colours(size)),
        strokes({&colour, &height}),
        finished({&picture}) {
    hal::FrameSize half = size;
    for (std::size_t i = 0; i < kHalvings; ++i) {
      half = {std::max(1, half.width / 2), std::max(1, half.height / 2)};
      reduced[i] = colours(half);
      reducedTarget[i] = gpu::RenderTarget({&reduced[i]});
    }
  }

  hal::FrameSize size;
  std::array<Texture, kHalvings> reduced;  // the frame's picture at 1/2, 1/4, 1/8
  std::array<gpu::RenderTarget, kHalvings> reducedTarget;
  Texture colour;
  Texture height;
  Texture picture;
  gpu::RenderTarget strokes;
  gpu::RenderTarget finished;
};

struct Layer {
  Layer(const gpu::ShaderLibrary& library, hal::FrameSize full, const LayerPlan& plan,
        std::size_t number)
      : anchors(library, full, anchorsOf(plan, number)), strokes(library, anchors.slotCount()) {}
  marks::AnchorSet anchors;
  marks::StrokeSet strokes;
};

/// What belongs to one full size and plan.
struct Painting {
  Painting(const gpu::ShaderLibrary& library, hal::FrameSize fullSize, const LayerPlan& given)
      : full(fullSize), plan(given), motion(library, full), field(library, full) {
    for (std::size_t i = 0; i < kLayers; ++i) {
      layers[i] = std::make_unique<Layer>(library, full, plan, i);
    }
  }
  hal::FrameSize full;
  LayerPlan plan;
  marks::MotionField motion;
  marks::TensorField field;
  std::array<std::unique_ptr<Layer>, kLayers> layers;
};

/// A layer's brush has as many texels as its strokes have pixels.
struct Brushes {
  LayerPlan plan;
  std::array<Texture, kLayers> textures;
};

}  // namespace

struct Painterly::State {
  explicit State(const gpu::ShaderLibrary& shaders)
      : library(shaders),
        halve(library.fragmentPass(kShaders + "halve.frag")),
        ground(library.fragmentPass(kShaders + "ground.frag")),
        relief(library.fragmentPass(kShaders + "relief.frag")),
        fieldView(library.fragmentPass(kShaders + "field_view.frag")),
        drawing(library) {}

  const gpu::ShaderLibrary& library;
  gpu::Program halve;
  gpu::Program ground;
  gpu::Program relief;
  gpu::Program fieldView;
  StrokeDrawing drawing;
  std::optional<Brush> brush;  // that `brushes` are of
  Brushes brushes;
  std::unique_ptr<Painting> painting;
  std::vector<std::unique_ptr<Canvas>> canvases;  // of each size that was painted
  Canvas* canvas = nullptr;                       // of this frame

  void take(const scene::ArFrame& frame, const PainterlyParameters& p);
  void reduce(const scene::ArFrame& frame, gpu::PassTimer& timer);
  void grow(const scene::ArFrame& frame, const PainterlyParameters& p, gpu::PassTimer& timer);
  void drawStrokes(const PainterlyParameters& p, gpu::PassTimer& timer);
  void light(const scene::ArFrame& frame, const PainterlyParameters& p, gpu::PassTimer& timer);
  void showField(const scene::ArFrame& frame, const PainterlyParameters& p, int shown);
  void showStrokes(const scene::ArFrame& frame, StrokeDrawing::Shown shown);
  const Texture& show(const scene::ArFrame& frame, const PainterlyParameters& p,
                      std::string_view view);
};

void Painterly::State::take(const scene::ArFrame& frame, const PainterlyParameters& p) {
  canvas = nullptr;
  if (painting == nullptr || painting->full != frame.full() || painting->plan != planOf(p)) {
    if (painting != nullptr && painting->full != frame.full()) canvases.clear();
    painting.reset();
    painting = std::make_unique<Painting>(library, frame.full(), planOf(p));
  }
  const auto isOfSize = [&](const auto& each) { return each->size == frame.size(); };
  const auto known = std::ranges::find_if(canvases, isOfSize);
  canvas = known != canvases.end()
               ? known->get()
               : canvases.emplace_back(std::make_unique<Canvas>(frame.size())).get();
  if (brush != p.brush || brushes.plan != painting->plan) {
    for (std::size_t i = 0; i < kLayers; ++i) {
      brushes.textures[i] = makeBrush(p.brush, texelsOf(painting->plan, i));
    }
    brushes.plan = painting->plan;
    brush = p.brush;
  }
}

void Painterly::State::reduce(const scene::ArFrame& frame, gpu::PassTimer& timer) {
  const auto scope = timer.measure("painterly: reduce");
  const Texture* from = frame.colour;
  for (std::size_t i = 0; i < kHalvings; ++i) {
    const hal::FrameSize size = canvas->reduced[i].size();
    halve.use()
        .texture("picture", *from)
        .set("size", glm::vec2(size.width, size.height))
        .drawFullscreen(canvas->reducedTarget[i]);
    from = &canvas->reduced[i];
  }
}

void Painterly::State::grow(const scene::ArFrame& frame, const PainterlyParameters& p,
                            gpu::PassTimer& timer) {
  painting->motion.update(frame, timer, motionOf(p));
  painting->field.update(frame, *frame.colour, painting->motion, fieldOf(p), timer);
  for (std::size_t i = 0; i < kLayers; ++i) {
    Layer& layer = *painting->layers[i];
    if (p.coherence <= 0.0) layer.anchors.beginAnew();
    layer.anchors.advance(frame, painting->motion, timer, anchorHoldOf(p));
    layer.strokes.update(frame, layer.anchors, painting->field, canvas->reduced[kLayers - 1 - i],
                         ruleOf(p, painting->plan, i), timer);
  }
}

void Painterly::State::drawStrokes(const PainterlyParameters& p, gpu::PassTimer& timer) {
  const auto scope = timer.measure("painterly: strokes");
  ground.use()
      .texture("paint", canvas->reduced[kHalvings - 1])
      .set("size", glm::vec2(canvas->size.width, canvas->size.height))
      .set("ground", glm::vec3(p.groundRed, p.groundGreen, p.groundBlue))
      .set("wash", static_cast<float>(p.wash))
      .drawFullscreen(canvas->strokes);
  for (std::size_t i = 0; i < kLayers; ++i) {
    drawing.draw(painting->layers[i]->strokes, kQuads, brushes.textures[i], painting->full,
                 canvas->strokes);
  }
}

void Painterly::State::light(const scene::ArFrame& frame, const PainterlyParameters& p,
                             gpu::PassTimer& timer) {
  const auto scope = timer.measure("painterly: light");
  const tracking::PlaneSimilarity& place = frame.canvasFromPicture;
  const double octave = std::exp2(-std::round(std::log2(place.scale())));
  relief.use()
      .texture("colours", canvas->colour)
      .texture("heights", canvas->height)
      .texture("frame", *frame.colour)
      .texture("normalFocus", frame.hasFocus ? *frame.normalFocus : *frame.colour)
      .set("hasFocus", frame.hasFocus ? 1 : 0)
      .set("relief", static_cast<float>(p.relief))
      .set("gloss", static_cast<float>(p.gloss))
      .set("weave", static_cast<float>(p.canvas))
      .set("canvasLinear", glm::vec2(place.linear * octave / frame.pixelsOfFull().x))
      .set("canvasShift", glm::vec2(place.shift * octave))
      .set("saturation", static_cast<float>(p.saturation))
      .set("warmth", static_cast<float>(p.warmth))
      .drawFullscreen(canvas->finished);
}

void Painterly::State::showField(const scene::ArFrame& frame, const PainterlyParameters& p,
                                 int shown) {
  const marks::TensorField& field = painting->field;
  const auto level = [&](std::size_t i) -> const Texture& {
    return field.resolved(std::min(i, field.levelCount() - 1));
  };
  fieldView.use()
      .texture("picture", *frame.colour)
      .texture("field0", level(0))
      .texture("field1", level(1))
      .texture("field2", level(2))
      .texture("field3", level(3))
      .set("size", glm::vec2(canvas->size.width, canvas->size.height))
      .set("shown", shown)
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .set("bands", glm::vec2(p.middleDetail, p.detail))
      .drawFullscreen(canvas->finished);
}

/// Over a pale picture.
void Painterly::State::showStrokes(const scene::ArFrame& frame, StrokeDrawing::Shown shown) {
  ground.use()
      .texture("paint", *frame.colour)
      .set("size", glm::vec2(canvas->size.width, canvas->size.height))
      .set("ground", glm::vec3(0.95F))
      .set("wash", 0.35F)
      .drawFullscreen(canvas->strokes);
  for (std::size_t i = 0; i < kLayers; ++i) {
    drawing.show(painting->layers[i]->strokes, kQuads, shown, kLayerColours[i], painting->full,
                 canvas->strokes);
  }
}

const Texture& Painterly::State::show(const scene::ArFrame& frame, const PainterlyParameters& p,
                                      std::string_view view) {
  if (view == kHeightView) return canvas->height;
  if (view == kTensorsView || view == kPyramidView || view == kRegionsView) {
    showField(frame, p, view == kTensorsView ? 0 : view == kPyramidView ? 1 : 2);
    return canvas->picture;
  }
  using Shown = StrokeDrawing::Shown;
  showStrokes(frame, view == kLayersView      ? Shown::kWhole
                     : view == kSkeletonsView ? Shown::kSkeletons
                                              : Shown::kAnchors);
  return canvas->colour;
}

Painterly::Painterly(const gpu::ShaderLibrary& library)
    : values_(painterlyParameters().defaults()), state_(std::make_unique<State>(library)) {}

Painterly::~Painterly() = default;

std::span<const ViewInfo> painterlyViews() {
  return kViews;
}

scene::ArFrameNeeds Painterly::needs() const {
  return {.surfaces = true, .pictureMovement = true, .shading = scene::Shading::kSmooth};
}

void Painterly::setParameters(const config::ParameterValues& values) {
  p_ = painterlyParameters().typed(values);
  values_ = values;
}

const Texture& Painterly::paint(const scene::ArFrame& frame, std::string_view view,
                                gpu::PassTimer& timer) {
  State& s = *state_;
  s.take(frame, p_);
  s.reduce(frame, timer);
  s.grow(frame, p_, timer);
  if (!view.empty() && view != kHeightView) return s.show(frame, p_, view);
  s.drawStrokes(p_, timer);
  s.light(frame, p_, timer);
  return view.empty() ? s.canvas->picture : s.show(frame, p_, view);
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

std::size_t Painterly::layerCount() const {
  return state_->painting ? state_->painting->layers.size() : 0;
}

Painterly::PaintedLayer Painterly::layer(std::size_t number) const {
  const Layer& layer = *state_->painting->layers.at(number);
  return {layer.anchors, layer.strokes};
}

void Painterly::reset() {
  if (!state_->painting) return;
  state_->painting->motion.reset();
  state_->painting->field.reset();
  for (const auto& layer : state_->painting->layers) layer->anchors.reset();
}

}  // namespace pleinair::styles
