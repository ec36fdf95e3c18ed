#include "firmware_app/procedure/step_pictures.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "firmware_app/procedure/step_arrows.h"
#include "firmware_app/procedure/step_close_up.h"
#include "firmware_app/procedure/step_composite.h"
#include "firmware_app/procedure/step_ghosts.h"
#include "firmware_app/procedure/step_view.h"
#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/gpu/gpu_shaders.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/present/present_shaders.h"
#include "pipeline/present/readback.h"
#include "pipeline/scene/render/ar_frame_renderer.h"
#include "pipeline/scene/scene_shaders.h"

namespace pleinair::app {
namespace {

constexpr hal::FrameSize kTrialSize{160, 120};
constexpr int kContextTag = 0;
constexpr int kFocusTag = 1;
constexpr int kGhostTag = 2;

gpu::Texture paperTexture(hal::FrameSize size) {
  gpu::Texture texture(gpu::TextureFormat::kRgba8, size, gpu::TextureFilter::kLinear);
  const auto width = static_cast<std::size_t>(size.width);
  std::vector<std::uint8_t> bytes(4 * width * static_cast<std::size_t>(size.height), 250);
  texture.upload(bytes, 4 * width);
  return texture;
}

/// Ghosts that stand still, beside their places.
struct GhostModel {
  scene::Model model;
  glm::dvec3 apartMetres{0.0};  ///< in the model's frame

  scene::BoundingSphere sphere() const {
    const scene::BoundingSphere home = scene::boundingSphere(model);
    return {.centre = home.centre + apartMetres, .radiusMetres = home.radiusMetres};
  }
};

/// Parts that are drawn alike.
struct PartGroup {
  scene::Model model;
  StepPixel look = StepPixel::kContext;
  bool isSubject = false;  ///< what the step is about
};

/// The models that a step shows: other parts first, then those with a look, and ghosts.
struct StepModels {
  std::vector<PartGroup> groups;
  std::vector<GhostModel> ghosts;
  std::vector<std::size_t> subject;  ///< parts that the step is about, and shows
};

std::vector<GhostModel> ghostModels(const procedure::Step& step,
                                    const procedure::Procedure& procedure) {
  std::vector<GhostModel> models;
  for (const overlay::Ghost& each : ghostsOf(step, *procedure.model, procedure.unitMetres)) {
    if (isStill(each)) {
      models.push_back({withParts(*procedure.model, std::array{each.part}), each.apartMetres});
    }
  }
  return models;
}

StepPixel lookOf(procedure::PartView view) {
  using procedure::PartView;
  switch (view) {
    case PartView::kPlain:
      return StepPixel::kContext;
    case PartView::kFocus:
      return StepPixel::kFocus;
    case PartView::kTint:
      return StepPixel::kTint;
    case PartView::kOutline:
      return StepPixel::kOutline;
    case PartView::kHidden:
    case PartView::kGhost:
      return StepPixel::kGround;
  }
  return StepPixel::kContext;
}

/// `off`: parts that are off when the step begins.
StepModels modelsOf(const procedure::Step& step, const procedure::Procedure& procedure,
                    const std::set<std::size_t>& off) {
  using procedure::PartView;
  StepModels models{.groups = {}, .ghosts = ghostModels(step, procedure), .subject = {}};
  std::map<std::pair<StepPixel, bool>, std::vector<std::size_t>> parts;  // kContext is the first
  for (std::size_t part = 0; part < procedure.model->parts.size(); ++part) {
    const bool isStepsPart = std::ranges::binary_search(step.parts, part);
    PartView view = isStepsPart          ? PartView::kFocus
                    : off.contains(part) ? PartView::kHidden
                                         : PartView::kPlain;
    for (const auto& [of, other] : step.views) {
      if (of == part) view = other;
    }
    const StepPixel look = lookOf(view);
    if (look == StepPixel::kGround) continue;
    parts[{look, isStepsPart && look != StepPixel::kContext}].push_back(part);
    if (isStepsPart) models.subject.push_back(part);
  }
  for (const auto& [key, of] : parts) {
    models.groups.push_back({withParts(*procedure.model, of), key.first, key.second});
  }
  return models;
}

/// The sphere around two; nothing may be in either.
scene::BoundingSphere around(const scene::BoundingSphere& one, const scene::BoundingSphere& other) {
  const double between = glm::distance(one.centre, other.centre);
  if (between + other.radiusMetres <= one.radiusMetres) return one;
  if (between + one.radiusMetres <= other.radiusMetres) return other;
  const double radius = 0.5 * (between + one.radiusMetres + other.radiusMetres);
  const glm::dvec3 towards = (other.centre - one.centre) / between;
  return {.centre = one.centre + (radius - one.radiusMetres) * towards, .radiusMetres = radius};
}

/// The scene that a step's pictures are drawn from: parts in focus on one tag, the others and
/// ghosts on others, so that each can be drawn with and without the rest.
scene::Scene sceneOf(const StepModels& models) {
  scene::Scene scene;
  scene.light.isEstimated = false;
  scene.light.shadow = 0.0F;
  for (const int id : {kContextTag, kFocusTag, kGhostTag}) {
    scene.tags.push_back({.id = id, .edgeMetres = 0.1});
  }
  const auto add = [&](const char* name, const scene::Model& model, int tag,
                       const glm::dvec3& at = glm::dvec3(0.0)) {
    scene.models.push_back({.name = name,
                            .model = std::make_shared<const scene::Model>(model),
                            .tagId = tag,
                            .attachFromModel = glm::translate(glm::dmat4(1.0), at),
                            .srgb = glm::vec3(1.0F)});
  };
  for (const PartGroup& each : models.groups) {
    add("parts", each.model, each.look == StepPixel::kFocus ? kFocusTag : kContextTag);
  }
  for (const GhostModel& each : models.ghosts) {
    add("ghost", each.model, kGhostTag, each.apartMetres);
  }
  return scene;
}

}  // namespace

struct StepPictures::Impl {
  Impl(const procedure::Procedure& procedureOf, hal::FrameSize size, bool drawsAxesToo)
      : procedure(procedureOf),
        drawsAxes(drawsAxesToo),
        large{2 * size.width, 2 * size.height},
        whole(scene::boundingSphere(*procedureOf.model)) {
    library.add(gpu::gpuShaders());
    library.add(gpu::sceneShaders());
    library.add(gpu::presentShaders());
    paper = paperTexture(large);
    trialPaper = paperTexture(kTrialSize);
    readback.emplace(library,
                     hal::FrameFormat{.pixelFormat = hal::PixelFormat::kRgb8, .size = large}, 1);
  }

  /// The step's models on the GPU.
  struct Drawing {
    std::unique_ptr<scene::ArFrameRenderer> renderer;
    /// By object of ArFrame::ids; those of ghosts are not among them.
    std::vector<StepPixel> looks{StepPixel::kGround};
    std::vector<bool> isSubject{false};
    bool hasFocus = false;
    std::uint32_t ghostObject = 0;  ///< the first of all; 0: none
    scene::BoundingSphere focusSphere;
    std::uint64_t sequence = 0;
  };

  enum class Drawn : std::uint8_t { kFocus = 1, kModel, kWithGhosts };  // how many sightings

  const scene::ArFrame& compose(Drawing& drawing, const gpu::Texture& ground,
                                const glm::dmat4& cameraFromAttach, Drawn drawn) {
    const glm::dmat4 cameraFromTag = cameraFromAttach * scene::kAttachFromTag;
    const std::array sightings{
        scene::TagSighting{.id = kFocusTag, .cameraFromTag = cameraFromTag},
        scene::TagSighting{.id = kContextTag, .cameraFromTag = cameraFromTag},
        scene::TagSighting{.id = kGhostTag, .cameraFromTag = cameraFromTag}};
    const std::span<const scene::TagSighting> seen(sightings);
    return drawing.renderer->compose(ground, stepCamera(ground.size()),
                                     {.tags = seen.first(static_cast<std::size_t>(drawn))},
                                     ++drawing.sequence, hal::TimePoint{},
                                     {.surfaces = true, .shading = scene::Shading::kSmooth});
  }

  /// Calls `take` with the object of each pixel, row by row.
  template <typename Take>
  void eachObject(Drawing& drawing, const gpu::Texture& ground, const glm::dmat4& cameraFromAttach,
                  Drawn drawn, const Take& take) {
    compose(drawing, ground, cameraFromAttach, drawn);
    const scene::SurfaceSnapshot snapshot = drawing.renderer->snapshot();
    for (int y = 0; y < ground.size().height; ++y) {
      for (int x = 0; x < ground.size().width; ++x) {
        take(snapshot.id(x, y) >> scene::kTriangleBits);
      }
    }
  }

  /// Where an object, or one after it, is seen. Empty if the step has none.
  std::vector<bool> maskFrom(Drawing& drawing, const gpu::Texture& ground,
                             const glm::dmat4& cameraFromAttach, Drawn drawn,
                             std::uint32_t object) {
    std::vector<bool> mask;
    if (object == 0) return mask;
    eachObject(drawing, ground, cameraFromAttach, drawn,
               [&](std::uint32_t seen) { mask.push_back(seen >= object); });
    return mask;
  }

  std::vector<StepPixel> pixelsOf(Drawing& drawing, const gpu::Texture& ground,
                                  const glm::dmat4& cameraFromAttach) {
    std::vector<StepPixel> pixels;
    // Where focus parts would be seen without the others: every object of that pass is one.
    const std::vector<bool> isFocus =
        maskFrom(drawing, ground, cameraFromAttach, Drawn::kFocus, drawing.hasFocus ? 1U : 0U);
    eachObject(drawing, ground, cameraFromAttach, Drawn::kModel, [&](std::uint32_t object) {
      const StepPixel look = drawing.looks[object];
      const bool covers = look != StepPixel::kGround && look != StepPixel::kFocus &&
                          !isFocus.empty() && isFocus[pixels.size()];
      pixels.push_back(covers ? StepPixel::kFocusHidden : look);
    });
    return pixels;
  }

  /// How many pixels show what the step is about.
  double shownIn(Drawing& drawing, const ViewAngles& view) {
    double shown = 0.0;
    eachObject(drawing, trialPaper,
               cameraFromModel(view, drawing.focusSphere, whole, procedure.uprightFromModel),
               Drawn::kModel,
               [&](std::uint32_t object) { shown += drawing.isSubject[object] ? 1.0 : 0.0; });
    return shown;
  }

  /// The view that shows most of the parts. The one before, so that a mechanic need not turn the
  /// machine in mind, and the usual one are left only for a much better one.
  ViewAngles bestView(Drawing& drawing) {
    constexpr double kMuchBetter = 1.4;
    const bool hasSubject = std::ranges::find(drawing.isSubject, true) != drawing.isSubject.end();
    if (!hasSubject) return lastView;
    ViewAngles best = lastView;
    double bestShown = shownIn(drawing, lastView);
    for (const ViewAngles& view : candidateViews()) {
      const double shown = shownIn(drawing, view);
      if (shown <= kMuchBetter * bestShown) continue;
      best = view;
      bestShown = shown;
    }
    lastView = best;
    return best;
  }

  Drawing drawingOf(const StepModels& models) {
    Drawing drawing;
    for (const PartGroup& each : models.groups) {
      drawing.looks.push_back(each.look);
      drawing.isSubject.push_back(each.isSubject);
      drawing.hasFocus = drawing.hasFocus || each.look == StepPixel::kFocus;
    }
    if (!models.ghosts.empty()) {
      drawing.ghostObject = static_cast<std::uint32_t>(drawing.looks.size());
    }
    drawing.focusSphere = models.subject.empty()
                              ? whole
                              : scene::boundingSphere(withParts(*procedure.model, models.subject));
    for (const GhostModel& each : models.ghosts) {
      drawing.focusSphere = around(drawing.focusSphere, each.sphere());
    }
    drawing.renderer = std::make_unique<scene::ArFrameRenderer>(library, sceneOf(models));
    return drawing;
  }

  hal::Image pictureFrom(Drawing& drawing, const glm::dmat4& camera,
                         std::span<const overlay::Arrow> arrows,
                         std::optional<std::size_t> axesOf) {
    const std::vector<StepPixel> pixels = pixelsOf(drawing, paper, camera);
    const scene::ArFrame& frame = compose(drawing, paper, camera, Drawn::kModel);
    readback->submit(*frame.colour);
    hal::Image shaded;
    hal::orThrow(readback->wait(shaded));
    hal::Image picture = stepComposite(
        shaded, pixels, maskFrom(drawing, paper, camera, Drawn::kWithGhosts, drawing.ghostObject));
    drawArrows(picture, arrows, *procedure.model, camera, stepCamera(picture.size()),
               picture.size().width / 480.0);
    if (axesOf) drawAxes(picture, *procedure.model, *axesOf, camera, stepCamera(picture.size()));
    return picture;
  }

  /// A part in the picture.
  struct PartPlace {
    scene::BoundingSphere sphere;
    glm::dvec2 px{0.0};
    double radiusPx = 0.0;
    double depth = 0.0;
  };

  /// The part of the step that is nearest to the viewer, if it is too small to be seen well.
  std::optional<PartPlace> smallPart(const StepModels& models, const glm::dmat4& camera,
                                     hal::FrameSize size) const {
    constexpr double kSmallShare = 0.055;  // of the picture's height
    std::optional<PartPlace> nearest;
    for (const std::size_t part : models.subject) {
      const scene::BoundingSphere sphere =
          scene::boundingSphere(withParts(*procedure.model, std::array{part}));
      const glm::dvec3 at(camera * glm::dvec4(sphere.centre, 1.0));
      const double radiusPx = stepCamera(size).intrinsics().fx * sphere.radiusMetres / at.z;
      if (radiusPx > kSmallShare * size.height) return std::nullopt;
      if (nearest && nearest->depth <= at.z) continue;
      nearest = {.sphere = sphere,
                 .px = stepCamera(size).project(at),
                 .radiusPx = radiusPx,
                 .depth = at.z};
    }
    return nearest;
  }

  hal::Image draw(std::size_t index, const std::set<std::size_t>& off) {
    const procedure::Step& step = procedure.steps[index];
    const StepModels models = modelsOf(step, procedure, off);
    Drawing drawing = drawingOf(models);
    const ViewAngles view = bestView(drawing);
    const std::vector<overlay::Arrow> arrows = arrowsOf(step, *procedure.model);
    const glm::dmat4 camera =
        cameraFromModel(view, drawing.focusSphere, whole, procedure.uprightFromModel);
    std::optional<std::size_t> axesOf;
    if (drawsAxes && !models.subject.empty()) axesOf = models.subject.front();
    const hal::FrameSize size{large.width / 2, large.height / 2};
    const std::optional<PartPlace> part = smallPart(models, camera, size);
    hal::Image picture = pictureFrom(drawing, camera, arrows, part ? std::nullopt : axesOf);
    if (!part) return picture;
    const glm::dvec3 middle(camera * glm::dvec4(drawing.focusSphere.centre, 1.0));
    const glm::dmat4 near = closeUpFromModel(view, part->sphere, procedure.uprightFromModel);
    setCloseUp(picture, pictureFrom(drawing, near, arrows, axesOf), part->px, 2.2 * part->radiusPx,
               stepCamera(size).project(middle));
    return picture;
  }

  const procedure::Procedure& procedure;
  bool drawsAxes = false;
  hal::FrameSize large;
  scene::BoundingSphere whole;
  ViewAngles lastView = candidateViews().front();
  gpu::EglContext context;
  gpu::ShaderLibrary library;
  gpu::Texture paper;
  gpu::Texture trialPaper;
  std::optional<present::Readback> readback;
};

StepPictures::StepPictures(const procedure::Procedure& procedure, hal::FrameSize size,
                           bool drawsAxes)
    : impl_(std::make_unique<Impl>(procedure, size, drawsAxes)) {}

StepPictures::~StepPictures() = default;

hal::Image StepPictures::draw(std::size_t step, const std::set<std::size_t>& off) {
  return impl_->draw(step, off);
}

}  // namespace pleinair::app
