#include "tests/gpu/inspection/rendered_parts.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include "firmware_app/procedure/step_view.h"
#include "hal/error.h"
#include "pipeline/gpu/gpu_shaders.h"
#include "pipeline/scene/builtin/builtin_gearbox.h"
#include "pipeline/scene/scene_shaders.h"
#include "tests/support/gl_test.h"
#include "tests/support/random_vectors.h"

namespace pleinair {
namespace {

constexpr hal::FrameSize kStillSize{320, 240};
constexpr int kMachineTag = 0;  // the parts have the tags behind it

tracking::CameraModel stillCamera() {
  const double f = 0.5 * kStillSize.height / std::tan(0.5 * glm::radians(app::kStepViewDeg));
  return {{.fx = f, .fy = f, .cx = 0.5 * kStillSize.width, .cy = 0.5 * kStillSize.height},
          {},
          kStillSize};
}

int tagOf(std::size_t part) {
  return static_cast<int>(part) + 1;
}

/// The machine on one tag, and each part alone on another one.
scene::Scene sceneOf(const scene::Model& machine, std::span<const std::size_t> parts,
                     const glm::dvec3& towardLight) {
  scene::Scene scene;
  scene.light.isEstimated = false;
  scene.light.shadow = 0.0F;
  scene.light.hasDirection = true;
  scene.light.towardLight = glm::normalize(towardLight);
  const auto add = [&](scene::Model model, int tag) {
    scene.tags.push_back({.id = tag, .edgeMetres = 0.1});
    scene.models.push_back({.name = std::to_string(tag),
                            .model = std::make_shared<const scene::Model>(std::move(model)),
                            .tagId = tag,
                            .srgb = glm::vec3(1.0F)});
  };
  add(machine, kMachineTag);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    add(app::withParts(machine, parts.subspan(i, 1)), tagOf(i));
  }
  return scene;
}

/// What a camera makes of it: a gain, a shadow's edge across the picture, noise.
void expose(hal::Image& image, bool isShaded, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::normal_distribution<double> noise(0.0, 3.0);
  const double gain = 0.7 + 0.5 * share(random);
  const double angle = 6.283185307179586 * share(random);
  const glm::dvec2 across(std::cos(angle), std::sin(angle));
  const double offset = 30.0 * (share(random) - 0.5);
  const glm::dvec2 middle(0.5 * kStillSize.width, 0.5 * kStillSize.height);
  for (int y = 0; y < kStillSize.height; ++y) {
    const auto row = image.row(0, y);
    for (int x = 0; x < kStillSize.width; ++x) {
      double light = gain;
      if (isShaded) {
        const double away = glm::dot(glm::dvec2(x, y) - middle, across) - offset;
        light *= 0.45 + 0.55 * std::clamp(0.5 + away / 3.0, 0.0, 1.0);
      }
      std::uint8_t& px = row[static_cast<std::size_t>(x)];
      px = static_cast<std::uint8_t>(std::clamp(light * px + noise(random), 0.0, 255.0));
    }
  }
}

glm::dvec3 direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return glm::normalize(support::randomVec3(normal, random));
}

/// Off by 0.3 mm and 0.25° about a point.
glm::dmat4 misplaced(const glm::dmat4& cameraFromModel, const glm::dvec3& about,
                     std::mt19937& random) {
  const glm::dvec3 shift = 0.0003 * direction(random);
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), glm::radians(0.25), direction(random));
  return cameraFromModel * glm::translate(glm::dmat4(1.0), about + shift) * turn *
         glm::translate(glm::dmat4(1.0), -about);
}

}  // namespace

RenderedParts::RenderedParts(std::span<const CheckedPart> parts)
    : parts_(parts.begin(), parts.end()), machine_(scene::gearboxModel({.isClosed = true})) {
  for (const CheckedPart& each : parts_) {
    const scene::ModelPart* const found = scene::findPart(machine_, each.name);
    assert(found != nullptr);
    indices_.push_back(static_cast<std::size_t>(found - machine_.parts.data()));
    surfaces_.push_back(app::surfaceOfParts(machine_, std::span(indices_).last(1)));
  }
  looks_.resize(parts_.size());
  for (scene::ModelPart& each : machine_.parts) each.radiansPerSecond = 0.0;
  library_.add(gpu::gpuShaders());
  library_.add(gpu::sceneShaders());
  paper_ = gpu::Texture(gpu::TextureFormat::kRgba8, kStillSize, gpu::TextureFilter::kLinear);
  const std::vector<std::uint8_t> bytes(4 * static_cast<std::size_t>(kStillSize.pixels()), 150);
  paper_.upload(bytes, 4 * static_cast<std::size_t>(kStillSize.width));
  usual_ = std::make_unique<scene::ArFrameRenderer>(
      library_, sceneOf(machine_, indices_, {-0.37, -0.56, 0.74}));
  fromElsewhere_ = std::make_unique<scene::ArFrameRenderer>(
      library_, sceneOf(machine_, indices_, {0.02, -0.67, 0.74}));
}

const scene::ArFrame& RenderedParts::compose(std::size_t index, const PartState& state,
                                             const glm::dmat4& cameraFromModel) {
  scene::ArFrameRenderer& renderer = state.isShaded ? *fromElsewhere_ : *usual_;
  std::vector<std::uint8_t> hidden(machine_.parts.size());
  hidden[indices_[index]] = 1;
  renderer.hideParts(0, hidden);
  // The part's frame with its middle as the origin.
  const glm::dmat4& place = machine_.parts[indices_[index]].modelFromPart;
  const glm::dvec3 axis = glm::normalize(glm::dmat3(place) * parts_[index].turnAxis);
  const glm::dvec3 middle(surfaces_[index].sphere.centre);
  const glm::dmat4 turned = glm::translate(glm::dmat4(1.0), middle) *
                            glm::rotate(glm::dmat4(1.0), glm::radians(state.turnedDeg), axis) *
                            glm::translate(glm::dmat4(1.0), -middle);
  const std::array sightings{
      scene::TagSighting{.id = kMachineTag,
                         .cameraFromTag = cameraFromModel * scene::kAttachFromTag},
      scene::TagSighting{.id = tagOf(index),
                         .cameraFromTag = cameraFromModel * turned * scene::kAttachFromTag}};
  const std::span<const scene::TagSighting> seen(sightings);
  return renderer.compose(paper_, stillCamera(), {.tags = seen.first(state.isMissing ? 1 : 2)},
                          ++sequence_, hal::TimePoint{},
                          {.surfaces = true, .shading = scene::Shading::kSmooth});
}

glm::dmat4 RenderedParts::cameraAt(std::size_t index, const Look& look) const {
  constexpr double kAround = 3.4;  // the part is half of the picture high, or less where it is flat
  const scene::BoundingSphere& sphere = surfaces_[index].sphere;
  return app::cameraFromModel(
      {look.azimuthDeg, look.elevationDeg}, sphere,
      {.centre = sphere.centre, .radiusMetres = kAround * sphere.radiusMetres});
}

RenderedParts::Look RenderedParts::bestLook(std::size_t index) {
  if (looks_[index]) return *looks_[index];
  Look best;
  std::ptrdiff_t most = -1;
  for (const app::ViewAngles& view : app::candidateViews()) {
    const Look look{view.azimuthDeg, view.elevationDeg};
    compose(index, {}, cameraAt(index, look));
    const scene::SurfaceSnapshot snapshot = usual_->snapshot();
    std::ptrdiff_t shown = 0;
    for (int y = 0; y < kStillSize.height; ++y) {
      for (int x = 0; x < kStillSize.width; ++x) {
        shown += (snapshot.id(x, y) >> scene::kTriangleBits) == index + 2 ? 1 : 0;
      }
    }
    if (shown <= most) continue;
    most = shown;
    best = look;
  }
  looks_[index] = best;
  return best;
}

hal::Image RenderedParts::render(std::size_t index, const PartState& state,
                                 const glm::dmat4& cameraFromModel) {
  const hal::Image drawn = support::readRgba8(*compose(index, state, cameraFromModel).colour);
  hal::Image grey({.pixelFormat = hal::PixelFormat::kGrey8, .size = kStillSize});
  for (int y = 0; y < kStillSize.height; ++y) {
    const auto from = drawn.view().row(0, y);
    const auto to = grey.row(0, y);
    for (std::size_t x = 0; x < to.size(); ++x) {
      to[x] = static_cast<std::uint8_t>(0.299 * from[4 * x] + 0.587 * from[4 * x + 1] +
                                        0.114 * from[4 * x + 2]);
    }
  }
  return grey;
}

PartStill RenderedParts::templateOf(std::size_t index) {
  const glm::dmat4 camera = cameraAt(index, bestLook(index));
  return {render(index, {}, camera), stillCamera(), camera};
}

PartStill RenderedParts::still(std::size_t index, const PartState& state, double azimuthDeg,
                               double elevationDeg, unsigned seed) {
  std::mt19937 random(seed);
  const Look best = bestLook(index);
  const glm::dmat4 camera =
      cameraAt(index, {best.azimuthDeg + azimuthDeg, best.elevationDeg + elevationDeg});
  PartStill still{render(index, state, camera), stillCamera(), {}};
  expose(still.image, state.isShaded, random);
  still.cameraFromModel = misplaced(camera, surfaces_[index].sphere.centre, random);
  return still;
}

}  // namespace pleinair
