#include "firmware_app/procedure/step_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <glm/trigonometric.hpp>

#include "firmware_app/procedure/step_arrows.h"
#include "firmware_app/procedure/step_composite.h"
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

gpu::Texture paperTexture(hal::FrameSize size) {
  gpu::Texture texture(gpu::TextureFormat::kRgba8, size, gpu::TextureFilter::kLinear);
  const auto width = static_cast<std::size_t>(size.width);
  std::vector<std::uint8_t> bytes(4 * width * static_cast<std::size_t>(size.height), 250);
  texture.upload(bytes, 4 * width);
  return texture;
}

/// What a step's pictures are drawn from: other parts on one tag, the step's parts on another, so
/// that the latter can be drawn with and without the former.
scene::Scene sceneOf(const std::optional<scene::Model>& context,
                     const std::optional<scene::Model>& focus) {
  scene::Scene scene;
  scene.light.isEstimated = false;
  scene.light.shadow = 0.0F;
  for (const int id : {kContextTag, kFocusTag}) scene.tags.push_back({.id = id, .edgeMetres = 0.1});
  const auto add = [&](const char* name, const scene::Model& model, int tag) {
    scene.models.push_back({.name = name,
                            .model = std::make_shared<const scene::Model>(model),
                            .tagId = tag,
                            .srgb = glm::vec3(1.0F)});
  };
  if (context) add("context", *context, kContextTag);
  if (focus) add("focus", *focus, kFocusTag);
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
    scene::BoundingSphere focusSphere;
    std::uint64_t sequence = 0;
  };

  const scene::ArFrame& compose(Drawing& drawing, const gpu::Texture& ground,
                                const glm::dmat4& cameraFromAttach, bool withContext) {
    const glm::dmat4 cameraFromTag = cameraFromAttach * scene::kAttachFromTag;
    const std::array sightings{
        scene::TagSighting{.id = kFocusTag, .cameraFromTag = cameraFromTag},
        scene::TagSighting{.id = kContextTag, .cameraFromTag = cameraFromTag}};
    const std::span<const scene::TagSighting> seen(sightings);
    return drawing.renderer->compose(ground, stepCamera(ground.size()),
                                     {.tags = seen.first(withContext ? 2 : 1)}, ++drawing.sequence,
                                     hal::TimePoint{},
                                     {.surfaces = true, .shading = scene::Shading::kSmooth});
  }

  std::vector<StepPixel> pixelsOf(Drawing& drawing, const gpu::Texture& ground,
                                  const glm::dmat4& cameraFromAttach) {
    std::vector<StepPixel> pixels;
    const auto each = [&](const scene::SurfaceSnapshot& snapshot, const auto& take) {
      for (int y = 0; y < ground.size().height; ++y) {
        for (int x = 0; x < ground.size().width; ++x) {
          take(snapshot.id(x, y) >> scene::kTriangleBits);
        }
      }
    };
    std::vector<bool> isFocus;
    if (drawing.focusObject != 0) {
      compose(drawing, ground, cameraFromAttach, false);
      each(drawing.renderer->snapshot(),
           [&](std::uint32_t object) { isFocus.push_back(object == drawing.focusObject); });
    }
    compose(drawing, ground, cameraFromAttach, true);
    each(drawing.renderer->snapshot(), [&](std::uint32_t object) {
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
    std::vector<std::size_t> others;
    for (std::size_t part = 0; part < procedure.model->parts.size(); ++part) {
      const bool isFocus = std::ranges::binary_search(step.parts, part);
      if (!isFocus && !off.contains(part)) others.push_back(part);
    }
    const auto modelOf = [&](const std::vector<std::size_t>& parts) {
      return parts.empty() ? std::nullopt : std::optional(withParts(*procedure.model, parts));
    };
    const std::optional<scene::Model> focus = modelOf(step.parts);
    const std::optional<scene::Model> surroundings = modelOf(others);
    Drawing drawing{.focusObject = focus ? (surroundings ? 2U : 1U) : 0U,
                    .focusSphere = focus ? scene::boundingSphere(*focus) : whole};
    drawing.renderer.emplace(library, sceneOf(surroundings, focus));
    const ViewAngles view = bestView(drawing);
    const glm::dmat4 camera =
        cameraFromModel(view, drawing.focusSphere, whole, procedure.uprightFromModel);
    const std::vector<StepPixel> pixels = pixelsOf(drawing, paper, camera);
    const scene::ArFrame& frame = compose(drawing, paper, camera, true);
    readback->submit(*frame.colour);
    hal::Image shaded;
    hal::orThrow(readback->wait(shaded));
    hal::Image picture = stepComposite(shaded, pixels);
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
