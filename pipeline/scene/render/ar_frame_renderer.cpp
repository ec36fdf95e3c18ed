#include "pipeline/scene/render/ar_frame_renderer.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "pipeline/scene/light/linear_image.h"
#include "pipeline/scene/render/footprints.h"
#include "pipeline/scene/render/scene_bodies.h"
#include "pipeline/scene/render/scene_uniforms.h"

namespace pleinair::scene {
namespace {

/// Nearer points are not drawn; this keeps depth precision for the rest of a model.
constexpr double kMinNearMetres = 1e-3;
constexpr double kMaxDepthRatio = 1000.0;
constexpr ArFrame kCameraOnly{.nearMetres = 0.1F, .farMetres = 10.0F};
constexpr glm::vec4 kNoNormal(128.0F / 255.0F, 128.0F / 255.0F, 128.0F / 255.0F, 0.0F);

bool isAlphaMasked(const Material& material) {
  return material.coverageCutoff > 0.0F;
}

/// Range of distances along the camera's axis in which a model lies.
struct DepthSpan {
  double nearest;
  double farthest;
};

DepthSpan depthSpan(const BoundingSphere& sphere, const glm::dmat4& cameraFromModel) {
  const double scale = glm::length(glm::dvec3(cameraFromModel[0]));
  const double middle = (cameraFromModel * glm::dvec4(sphere.centre, 1.0)).z;
  const double radius = scale * sphere.radiusMetres;
  return {middle - radius, middle + radius};
}

}  // namespace

ArFrameRenderer::ArFrameRenderer(const gpu::ShaderLibrary& library, Scene scene)
    : scene_(std::move(scene)),
      geometry_(library, scene_),
      bodies_(scene_),
      lights_(scene_.models.size()),
      lastFoci_(scene_.foci.size()),
      firstSight_(scene_.models.size()) {
  assert(scene_.models.size() <= kMaxObjects && scene_.planes.size() <= kMaxPlanes);
  visible_.reserve(scene_.models.size());
  foci_.reserve(scene_.foci.size());
  footprints_.reserve(kMaxFootprints);
  makePrograms(library);
}

void ArFrameRenderer::makePrograms(const gpu::ShaderLibrary& library) {
  for (std::size_t i = 0; i < scene_.models.size(); ++i) objects_.push_back(objectId(scene_, i));
  if (!scene_.models.empty() || !scene_.planes.empty()) {
    surfacePass_.emplace(library, scene_, geometry_);
  }
  if (scene_.models.empty()) return;
  constexpr std::string_view kVertices = "pipeline/scene/render/shaders/model.vert";
  background_ = library.fragmentPass("pipeline/scene/render/shaders/camera_background.frag");
  const bool hasAlphaMask = std::ranges::any_of(scene_.models, [](const SceneModel& each) {
    return std::ranges::any_of(each.model->materials, isAlphaMasked);
  });
  for (const Shading shading : {Shading::kToon, Shading::kSmooth}) {
    constexpr std::string_view kFragments = "pipeline/scene/render/shaders/model.frag";
    gpu::ShaderDefines defines;
    if (shading == Shading::kToon) defines.push_back({"TOON"});
    SurfacePrograms& programs = programsOf(shading);
    programs.solid = library.draw(kVertices, kFragments, defines);
    defines.push_back({"MASKED"});
    if (hasAlphaMask) programs.alphaMasked = library.draw(kVertices, kFragments, defines);
  }
  if (std::ranges::any_of(scene_.models, &SceneModel::isOccluder)) {
    occluder_ = library.draw(kVertices, "pipeline/scene/render/shaders/occluder.frag");
  }
  if (scene_.light.shadow > 0.0F) shadow_.emplace(library, scene_, geometry_);
  white_ = gpu::Texture(gpu::TextureFormat::kRgba8, {1, 1});
  white_.upload(std::array<std::uint8_t, 4>{255, 255, 255, 255}, 4);
}

/// Without models and planes, all texels would be the same.
ArFrameRenderer::Surfaces::Surfaces(hal::FrameSize pictureSize, bool hasModels, bool hasPlanes)
    : size(hasModels || hasPlanes ? pictureSize : hal::FrameSize{1, 1}),
      ids(gpu::TextureFormat::kR32ui, size),
      normalFocus(gpu::TextureFormat::kRgba8, size),
      depth(gpu::TextureFormat::kDepth24, size),
      withoutColour({&ids, &normalFocus}, &depth) {
  if (!hasModels) return;
  colour = gpu::Texture(gpu::TextureFormat::kRgba8, size, gpu::TextureFilter::kLinear);
  target = gpu::RenderTarget({&colour, &ids, &normalFocus}, &depth);
}

void ArFrameRenderer::takeSurfaces(hal::FrameSize size) {
  surfacesNow_ = &surfaces_.of(size, size, !scene_.models.empty(), !scene_.planes.empty());
}

/// Runs everything once that a frame may need: poses in front of the camera, draws, and reads.
void ArFrameRenderer::warmUp(hal::FrameSize size) {
  takeSurfaces(size);
  if (!surfacePass_) return;
  const tracking::CameraModel camera = assumedCamera(size);
  if (!surfacesNow_->buffers) surfacesNow_->buffers.emplace(size);
  visible_.clear();
  if (!scene_.models.empty()) {
    const gpu::Texture picture(gpu::TextureFormat::kRgba8, size, gpu::TextureFilter::kLinear);
    geometry_.beginFrame();
    for (std::size_t i = 0; i < scene_.models.size(); ++i) {
      // Equal models use the same programs in the same states.
      const auto isEqual = [&](std::size_t earlier) {
        return scene_.models[earlier].model == scene_.models[i].model &&
               scene_.models[earlier].isOccluder == scene_.models[i].isOccluder;
      };
      if (std::ranges::any_of(visible_, isEqual)) continue;
      geometry_.pose(i, {}, {});
      visible_.push_back(i);
    }
    geometry_.endPosing();
    bodies_.reset();
    if (shadow_) shadow_->warmUp();
    drawBackground(picture);
    for (const Shading shading : {Shading::kToon, Shading::kSmooth}) {
      shading_ = shading;
      setCamera(camera);
      if (shadow_) shadow_->draw();
      drawModels(picture);
    }
    surfacesNow_->showsCameraOnly = false;
  }
  surfacePass_->warmUp(surfacesNow_->ids, camera, bodies_, *surfacesNow_->buffers);
  reset();
}

void ArFrameRenderer::reset() {
  geometry_.reset();
  bodies_.reset();
  if (shadow_) shadow_->reset();
  lastStamp_.reset();
  firstTime_.reset();
  std::ranges::fill(firstSight_, std::nullopt);
  std::ranges::fill(lastFoci_, std::nullopt);
}

const ArFrame& ArFrameRenderer::compose(const gpu::Texture& picture,
                                        const tracking::CameraModel& camera, const PoseSet& poses,
                                        std::uint64_t sequence, hal::TimePoint captureTime,
                                        ArFrameNeeds needs, std::span<const PlaceLighting> lights) {
  assert(picture.size() == camera.imageSize());
  takeSurfaces(picture.size());
  if (!firstTime_) firstTime_ = captureTime;
  bodies_.advance(poses);
  poseModels(captureTime);
  findVisible();
  findLights(lights);
  findFoci(poses, camera);
  shading_ = needs.shading;
  if (shadow_) shadow_->cast(visible_, bodies_, lights_);
  drawFrame(picture, camera);
  frame_.colour = visible_.empty() ? &picture : &surfacesNow_->colour;
  frame_.cameraColour = &picture;
  frame_.ids = &surfacesNow_->ids;
  frame_.normalFocus = &surfacesNow_->normalFocus;
  frame_.depth = &surfacesNow_->depth;
  frame_.hasObjects = !visible_.empty();
  frame_.sceneHasModels = !geometry_.isEmpty();
  frame_.hasFocus = std::ranges::any_of(
      visible_, [&](std::size_t each) { return scene_.models[each].focus > 0.0F; });
  frame_.foci = foci_;
  findFootprints(scene_, geometry_, bodies_, visible_, camera, footprints_);
  frame_.footprints = footprints_;
  if (!visible_.empty()) {
    frame_.composition = Composition{.picture = &surfacesNow_->target, .surfaces = nullptr};
  }
  frame_.sequence = sequence;
  frame_.captureTime = captureTime;
  if (needs.surfaces && surfacePass_) findSurfaces(camera);
  lastStamp_ = Stamp{sequence, captureTime};
  return frame_;
}

SurfaceSnapshot ArFrameRenderer::snapshot() {
  if (visible_.empty() || frame_.barycentrics == nullptr) {
    return SurfaceSnapshot(frame_.colour->size());
  }
  return reader_.read(geometry_, bodies_, visible_, objects_, *camera_, *frame_.ids,
                      *frame_.barycentrics);
}

void ArFrameRenderer::poseModels(hal::TimePoint captureTime) {
  geometry_.beginFrame();
  for (std::size_t i = 0; i < scene_.models.size(); ++i) {
    if (!bodies_.model(i).current) continue;
    if (!firstSight_[i]) firstSight_[i] = captureTime;
    const hal::TimePoint start =
        scene_.models[i].playback.startsOnSight ? *firstSight_[i] : *firstTime_;
    geometry_.pose(i, captureTime - start, captureTime - *firstTime_);
  }
  geometry_.endPosing();
}

void ArFrameRenderer::drawFrame(const gpu::Texture& picture, const tracking::CameraModel& camera) {
  frame_ = kCameraOnly;
  if (visible_.empty()) {
    clearToCamera();
    return;
  }
  drawBackground(picture);
  setCamera(camera);
  if (shadow_) shadow_->draw();
  drawModels(picture);
  surfacesNow_->showsCameraOnly = false;
}

void ArFrameRenderer::findVisible() {
  visible_.clear();
  for (std::size_t i = 0; i < scene_.models.size(); ++i) {
    const auto& current = bodies_.model(i).current;
    if (!current || geometry_.batches(i).empty()) continue;
    const DepthSpan span = depthSpan(geometry_.sphere(i), current->cameraFromBody);
    if (span.farthest > kMinNearMetres) visible_.push_back(i);
  }
}

void ArFrameRenderer::findLights(std::span<const PlaceLighting> lights) {
  for (const std::size_t i : visible_) {
    const glm::dmat3 cameraFromAttach(bodies_.model(i).current->attachment.cameraFromAttach);
    const auto known = std::ranges::find(lights, scene_.models[i].tagId, &PlaceLighting::tagId);
    const Lighting light = known != lights.end()
                               ? withSceneDirection(known->light, scene_.light, cameraFromAttach)
                               : fixedLighting(scene_.light, cameraFromAttach);
    lights_[i] = turned(glm::mat3(cameraFromAttach), light);
  }
}

void ArFrameRenderer::clearToCamera() {
  if (surfacesNow_->showsCameraOnly) return;
  surfacesNow_->withoutColour.beginDiscarding();
  surfacesNow_->withoutColour.clearUnsigned(0, glm::uvec4(0U));
  surfacesNow_->withoutColour.clearColour(1, kNoNormal);
  surfacesNow_->withoutColour.clearDepth();
  surfacesNow_->showsCameraOnly = true;
}

/// A focus whose tag is not seen, or that is behind the camera, stays where it was last.
void ArFrameRenderer::findFoci(const PoseSet& poses, const tracking::CameraModel& camera) {
  foci_.clear();
  for (std::size_t i = 0; i < scene_.foci.size(); ++i) {
    const SceneFocus& focus = scene_.foci[i];
    if (const auto attachment = attachmentOf(scene_, focus.tagId, poses)) {
      const glm::dvec3 centre(attachment->cameraFromAttach *
                              glm::dvec4(focus.attachFromCentre, 1.0));
      if (centre.z > kMinNearMetres) {
        const double pxPerMetre = camera.intrinsics().fx / centre.z;
        lastFoci_[i] = FocusPlace{.px = camera.project(centre),
                                  .radiusPx = static_cast<float>(pxPerMetre * focus.radiusMetres),
                                  .falloffPx = static_cast<float>(pxPerMetre * focus.falloffMetres),
                                  .strength = static_cast<float>(focus.strength)};
      }
    }
    if (lastFoci_[i]) foci_.push_back(*lastFoci_[i]);
  }
}

void ArFrameRenderer::drawBackground(const gpu::Texture& picture) {
  // Depth is cleared at the start of the pass: later, a tile-based GPU would split the pass
  // (docs/gpu.md, rule 10).
  surfacesNow_->target.beginDiscarding();
  surfacesNow_->target.clearDepth();
  background_.use()
      .texture("picture", picture)
      .drawArea(surfacesNow_->target, {0, 0}, surfacesNow_->target.size());
}

void ArFrameRenderer::setCamera(const tracking::CameraModel& camera) {
  double nearest = HUGE_VAL;
  double farthest = kMinNearMetres * kMaxDepthRatio;
  for (const std::size_t i : visible_) {
    const auto& current = bodies_.model(i).current;
    const auto span =
        depthSpan(geometry_.sphere(i), current ? current->cameraFromBody : glm::dmat4(1.0));
    nearest = std::min(nearest, span.nearest);
    farthest = std::max(farthest, span.farthest);
  }
  farthest *= 1.001;  // margin for rounding
  nearest = std::max(0.999 * nearest, farthest / kMaxDepthRatio);
  frame_.nearMetres = static_cast<float>(nearest);
  frame_.farMetres = static_cast<float>(farthest);

  const glm::dvec2 size(camera.imageSize().width, camera.imageSize().height);
  const tracking::Intrinsics& pinhole = camera.intrinsics();
  const double range = farthest - nearest;
  gpu::Program* receiver = shadow_ ? &shadow_->receiver() : nullptr;
  SurfacePrograms& surfaces = programsOf(shading_);
  for (gpu::Program* program : {&surfaces.solid, &surfaces.alphaMasked, &occluder_, receiver}) {
    if (program == nullptr || !*program) continue;
    program->use()
        .set("clipFocal", glm::vec2(2.0 * glm::dvec2(pinhole.fx, pinhole.fy) / size))
        .set("clipCentre", glm::vec2(2.0 * glm::dvec2(pinhole.cx, pinhole.cy) / size - 1.0));
    if (program != receiver) {
      program->set("clipDepth",
                   glm::vec2((farthest + nearest) / range, -2.0 * farthest * nearest / range));
    }
    setLens(*program, camera);
  }
}

void ArFrameRenderer::drawModels(const gpu::Texture& picture) {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glFrontFace(GL_CW);  // image rows go down, GL's go up
  for (const std::size_t i : visible_) drawModel(i, picture);
  PosedGeometry::unbind();
  glFrontFace(GL_CCW);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
}

void ArFrameRenderer::drawModel(std::size_t index, const gpu::Texture& picture) {
  if (geometry_.batches(index).empty()) return;
  geometry_.bind(index);
  const Model& model = geometry_.model(index);
  const bool isOccluder = scene_.models[index].isOccluder;
  for (const DrawBatch& batch : geometry_.batches(index)) {
    const Material& material = model.materials[batch.material];
    SurfacePrograms& programs = programsOf(shading_);
    gpu::Program* const program = isOccluder                ? &occluder_
                                  : isAlphaMasked(material) ? &programs.alphaMasked
                                                            : &programs.solid;
    if (isOccluder) {
      beginModel(*program, index).texture("picture", picture);
    } else {
      setMaterial(beginModel(*program, index), index, material);
    }
    (material.isDoubleSided ? glDisable : glEnable)(GL_CULL_FACE);
    const gpu::PassTimer::Scope scope = program->measure();
    geometry_.draw(index, batch);
  }
}

/// Sets the uniforms that all materials of a model share.
gpu::Program& ArFrameRenderer::beginModel(gpu::Program& program, std::size_t index) {
  const Body::Moment current = bodies_.model(index).current.value_or(Body::Moment{});
  program.use();
  // Rotation and uniform scale: normals, of any length, transform like positions.
  return program.set("cameraFromModel", glm::mat4(current.cameraFromBody))
      .set("cameraFromModelNormals", glm::mat3(glm::dmat3(current.cameraFromBody)))
      .set("object", objectId(scene_, index));
}

void ArFrameRenderer::setMaterial(gpu::Program& program, std::size_t index,
                                  const Material& material) {
  setLighting(program, lights_[index], shading_);
  program.set("focus", scene_.models[index].focus);
  const glm::vec4 tint(linearFromSrgb(scene_.models[index].srgb), 1.0F);
  program.set("baseColour", tint * material.baseColour)
      .texture("baseTexture",
               material.texture ? geometry_.textures(index)[*material.texture] : white_);
  if (isAlphaMasked(material)) program.set("coverageCutoff", material.coverageCutoff);
}

void ArFrameRenderer::findSurfaces(const tracking::CameraModel& camera) {
  if (!surfacesNow_->buffers) surfacesNow_->buffers.emplace(surfacesNow_->ids.size());
  surfacePass_->run(surfacesNow_->ids, camera, bodies_, visible_, *surfacesNow_->buffers);
  frame_.barycentrics = &surfacesNow_->buffers->barycentrics;
  frame_.parts = &surfacesNow_->buffers->parts;
  frame_.forms = &surfacesNow_->buffers->forms;
  const ScreenArea& objects = surfacesNow_->buffers->objects;
  frame_.objectBounds = glm::ivec4(objects.origin, objects.origin + objects.size);
  if (frame_.composition) frame_.composition->surfaces = &surfacesNow_->buffers->target;
  camera_ = camera;
  frame_.surfaces =
      SurfaceAccess{.posed = geometry_.isEmpty() ? nullptr : &geometry_.posed(),
                    .triangles = geometry_.isEmpty() ? nullptr : &geometry_.triangles(),
                    .bodies = &surfacePass_->bodies(),
                    .planeCount = scene_.planes.size(),
                    .models = visible_,
                    .objects = objects_,
                    .camera = &*camera_};
  if (!lastStamp_) return;
  frame_.motion = SurfaceMotion{.texture = &surfacesNow_->buffers->motion,
                                .sinceSequence = lastStamp_->sequence,
                                .sinceTime = lastStamp_->time};
}

}  // namespace pleinair::scene
