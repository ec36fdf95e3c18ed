#include "firmware_app/procedure/step_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "firmware_app/procedure/step_arrows.h"
#include "firmware_app/procedure/step_composite.h"
#include "firmware_app/procedure/step_ghosts.h"
#include "firmware_app/procedure/step_view.h"
#include "pipeline/gpu/egl_context.h"
#include "pipeline/gpu/gpu_shaders.h"
#include "pipeline/gpu/shader_library.h"
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

/// The models that a step shows: its parts, the others, and ghosts.
struct StepModels {
  std::optional<scene::Model> focus, context;
  std::vector<GhostModel> ghosts;
};

std::optional<scene::Model> modelOf(const scene::Model& machine,
                                    const std::vector<std::size_t>& parts) {
  return parts.empty() ? std::nullopt : std::optional(withParts(machine, parts));
}

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

/// `off`: parts that are off when the step begins.
StepModels modelsOf(const procedure::Step& step, const procedure::Procedure& procedure,
                    const std::set<std::size_t>& off) {
  using procedure::PartView;
  std::vector<std::size_t> focus;
  std::vector<std::size_t> context;
  for (std::size_t part = 0; part < procedure.model->parts.size(); ++part) {
    const bool isStepsPart = std::ranges::binary_search(step.parts, part);
    PartView view = isStepsPart          ? PartView::kFocus
                    : off.contains(part) ? PartView::kHidden
                                         : PartView::kPlain;
    for (const auto& [of, other] : step.views) {
      if (of == part) view = other;
    }
    if (view == PartView::kPlain) context.push_back(part);
    const bool isMarked =
        view == PartView::kFocus || view == PartView::kTint || view == PartView::kOutline;
    if (isMarked) focus.push_back(part);
  }
  return {.focus = modelOf(*procedure.model, focus),
          .context = modelOf(*procedure.model, context),
          .ghosts = ghostModels(step, procedure)};
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

/// The scene that a step's pictures are drawn from: other parts on one tag, the step's parts and
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
  if (models.context) add("context", *models.context, kContextTag);
  if (models.focus) add("focus", *models.focus, kFocusTag);
  for (const GhostModel& each : models.ghosts) {
    add("ghost", each.model, kGhostTag, each.apartMetres);
  }
  return scene;
}

}  // namespace

struct StepPictures::Impl {
  Impl(const procedure::Procedure& procedureOf, hal::FrameSize size)
      : procedure(procedureOf),
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
    std::optional<scene::ArFrameRenderer> renderer;
    std::uint32_t focusObject = 0;  ///< in ArFrame::ids; 0: none
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
    const std::vector<bool> isFocus =
        maskFrom(drawing, ground, cameraFromAttach, Drawn::kFocus, drawing.focusObject);
    eachObject(drawing, ground, cameraFromAttach, Drawn::kModel, [&](std::uint32_t object) {
      const bool covers = !isFocus.empty() && isFocus[pixels.size()];
      if (object == 0) {
        pixels.push_back(StepPixel::kGround);
      } else if (object == drawing.focusObject) {
        pixels.push_back(StepPixel::kFocus);
      } else {
        pixels.push_back(covers ? StepPixel::kFocusHidden : StepPixel::kContext);
      }
    });
    return pixels;
  }

  /// The view that shows most of the parts. The usual one is left only for a much better one.
  ViewAngles bestView(Drawing& drawing) {
    constexpr double kMuchBetter = 1.4;
    ViewAngles best = candidateViews().front();
    if (drawing.focusObject == 0) return best;
    double bestShown = -1.0;
    for (const ViewAngles& view : candidateViews()) {
      const auto pixels =
          pixelsOf(drawing, trialPaper,
                   cameraFromModel(view, drawing.focusSphere, whole, procedure.uprightFromModel));
      const auto shown = static_cast<double>(std::ranges::count(pixels, StepPixel::kFocus));
      if (shown <= kMuchBetter * bestShown) continue;
      best = view;
      bestShown = shown;
    }
    return best;
  }

  hal::Image draw(std::size_t index, const std::set<std::size_t>& off) {
    const procedure::Step& step = procedure.steps[index];
    const StepModels models = modelsOf(step, procedure, off);
    Drawing drawing{.focusSphere = models.focus ? scene::boundingSphere(*models.focus) : whole};
    std::uint32_t objects = models.context ? 1 : 0;
    if (models.focus) drawing.focusObject = ++objects;
    if (!models.ghosts.empty()) drawing.ghostObject = ++objects;
    for (const GhostModel& each : models.ghosts) {
      drawing.focusSphere = around(drawing.focusSphere, each.sphere());
    }
    drawing.renderer.emplace(library, sceneOf(models));
    const ViewAngles view = bestView(drawing);
    const glm::dmat4 camera =
        cameraFromModel(view, drawing.focusSphere, whole, procedure.uprightFromModel);
    const std::vector<StepPixel> pixels = pixelsOf(drawing, paper, camera);
    const scene::ArFrame& frame = compose(drawing, paper, camera, Drawn::kModel);
    readback->submit(*frame.colour);
    hal::Image shaded;
    hal::orThrow(readback->wait(shaded));
    hal::Image picture = stepComposite(
        shaded, pixels, maskFrom(drawing, paper, camera, Drawn::kWithGhosts, drawing.ghostObject));
    drawArrows(picture, arrowsOf(step, *procedure.model), *procedure.model, camera,
               stepCamera(picture.size()), picture.size().width / 480.0);
    return picture;
  }

  const procedure::Procedure& procedure;
  hal::FrameSize large;
  scene::BoundingSphere whole;
  gpu::EglContext context;
  gpu::ShaderLibrary library;
  gpu::Texture paper;
  gpu::Texture trialPaper;
  std::optional<present::Readback> readback;
};

StepPictures::StepPictures(const procedure::Procedure& procedure, hal::FrameSize size)
    : impl_(std::make_unique<Impl>(procedure, size)) {}

StepPictures::~StepPictures() = default;

hal::Image StepPictures::draw(std::size_t step, const std::set<std::size_t>& off) {
  return impl_->draw(step, off);
}

}  // namespace pleinair::app
