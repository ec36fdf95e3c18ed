#include "pipeline/scene/render/contact_shadow.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace pleinair::scene {
namespace {

constexpr hal::FrameSize kMapSize{kShadowMapTexels, kShadowMapTexels};
/// Half width of the key light, as growth of the penumbra with height: a window's rather than the
/// sun's.
constexpr double kSoftness = 0.13;
constexpr double kSharpestTexels = 1.25;
/// Ambient light is blocked below parts lower than this, in radii of the model.
constexpr double kContactHeight = 0.50;
constexpr double kContactReach = 0.30;
constexpr int kReceiverCells = 16;  // per side; a lens bends lines

constexpr std::array<GLenum, 3> kFirstAlone{GL_COLOR_ATTACHMENT0, GL_NONE, GL_NONE};
constexpr std::array<GLenum, 3> kAll{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1,
                                     GL_COLOR_ATTACHMENT2};

glm::dmat4 attachFromCamera(const glm::dmat4& cameraFromAttach) {
  const glm::dmat3 rotation = glm::transpose(glm::dmat3(cameraFromAttach));
  glm::dmat4 inverse(rotation);
  inverse[3] = glm::dvec4(-(rotation * glm::dvec3(cameraFromAttach[3])), 1.0);
  return inverse;
}

}  // namespace

ContactShadow::Map::Map()
    : heights(gpu::TextureFormat::kRg8, kMapSize),
      depth(gpu::TextureFormat::kDepth24, kMapSize),
      halfBlurred(gpu::TextureFormat::kRgba8, kMapSize),
      blurred(gpu::TextureFormat::kRg8, kMapSize, gpu::TextureFilter::kLinear),
      castTarget({&heights}, &depth),
      halfTarget({&halfBlurred}),
      target({&blurred}) {}

ContactShadow::ContactShadow(const gpu::ShaderLibrary& library, const Scene& scene,
                             const PosedGeometry& geometry)
    : scene_(scene),
      geometry_(geometry),
      casters_(scene, geometry),
      cast_(library.draw("pipeline/scene/render/shaders/shadow_cast.vert",
                         "pipeline/scene/render/shaders/shadow_cast.frag")),
      blurAcross_(library.fragmentPass("pipeline/scene/render/shaders/shadow_blur_across.frag")),
      blurDown_(library.fragmentPass("pipeline/scene/render/shaders/shadow_blur_down.frag")),
      receive_(library.draw("pipeline/scene/render/shaders/shadow_receive.vert",
                            "pipeline/scene/render/shaders/shadow_receive.frag")),
      noAttributes_(gpu::VertexArrayHandle::make()) {
  for (std::size_t i = 0; i < scene.models.size(); ++i) {
    const std::optional<int>& tagId = scene.models[i].tagId;
    const bool isNew = std::ranges::find(maps_, tagId, &Map::tagId) == maps_.end();
    if (!casters_.casts(i) || !isNew || maps_.size() == kMaxShadowMaps) continue;
    maps_.emplace_back().tagId = tagId;
  }
  for (Map& map : maps_) map.casters.reserve(scene.models.size());
  objects_.reserve(scene.models.size());
  poses_.reserve(scene.models.size());
  spheres_.reserve(scene.models.size());
}

void ContactShadow::warmUp() {
  if (maps_.empty()) return;
  Map& map = maps_.front();
  map.plan = ShadowPlan{.half = 1.0, .height = 1.0};
  map.contactHeight = 1.0;
  objects_.clear();
  poses_.assign(1, glm::dmat4(1.0));
  for (std::size_t i = 0; i < scene_.models.size() && objects_.empty(); ++i) {
    if (casters_.casts(i)) objects_.push_back(i);
  }
  drawCasters(map);
  blur(map);
  map.isShown = true;
}

void ContactShadow::reset() {
  for (Map& map : maps_) {
    map.plan.reset();
    map.isShown = false;
  }
}

void ContactShadow::cast(std::span<const std::size_t> visible, const SceneBodies& bodies,
                         std::span<const Lighting> cameraLights) {
  for (Map& map : maps_) castMap(map, visible, bodies, cameraLights);
}

void ContactShadow::castMap(Map& map, std::span<const std::size_t> visible,
                            const SceneBodies& bodies, std::span<const Lighting> cameraLights) {
  map.isShown = false;
  objects_.clear();
  poses_.clear();
  spheres_.clear();
  for (const std::size_t i : visible) {
    const auto& current = bodies.model(i).current;
    if (!current || scene_.models[i].tagId != map.tagId || !casters_.casts(i)) continue;
    const glm::dmat4& attachFromModel = scene_.models[i].attachFromModel;
    const BoundingSphere& sphere = geometry_.sphere(i);
    objects_.push_back(i);
    poses_.push_back(attachFromModel);
    spheres_.push_back(
        {.centre = glm::dvec3(attachFromModel * glm::dvec4(sphere.centre, 1.0)),
         .radiusMetres = glm::length(glm::dvec3(attachFromModel[0])) * sphere.radiusMetres});
    map.cameraFromAttach = current->attachment.cameraFromAttach;
    map.light = cameraLights[i];
  }
  if (objects_.empty()) return;
  const glm::dvec3 origin(map.cameraFromAttach[3]);
  if (glm::dot(origin, glm::dvec3(map.cameraFromAttach[2])) >= 0.0) return;  // seen from below
  const Lighting attachLight = turned(glm::mat3(attachFromCamera(map.cameraFromAttach)), map.light);
  const auto plan = planShadow(spheres_, glm::dvec3(attachLight.towardKey), map.plan);
  if (!plan) return;
  map.isShown = true;
  if (isUpToDate(map, *plan)) return;
  map.plan = plan;
  map.casters.assign(poses_.begin(), poses_.end());
  double radius = 0.0;
  for (const BoundingSphere& sphere : spheres_) radius = std::max(radius, sphere.radiusMetres);
  map.contactHeight = kContactHeight * radius;
  drawCasters(map);
  blur(map);
}

bool ContactShadow::isUpToDate(const Map& map, const ShadowPlan& plan) const {
  constexpr double kSameShear = 2e-3;  // a tenth of a texel; poses are rounded
  if (!map.plan || map.plan->half != plan.half || map.plan->centre != plan.centre ||
      map.plan->height != plan.height) {
    return false;
  }
  if (glm::distance(map.plan->shear, plan.shear) > kSameShear || map.casters != poses_)
    return false;
  return std::ranges::all_of(objects_, [&](std::size_t each) { return geometry_.isStatic(each); });
}

void ContactShadow::drawCasters(const Map& map) {
  map.castTarget.beginDiscarding();
  map.castTarget.clearColour(0, glm::vec4(0.0F));
  map.castTarget.clearDepth();
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  cast_.use();
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    cast_.set("mapFromModel", glm::mat4(map.plan->mapFromAttach() * poses_[i]));
    const gpu::PassTimer::Scope scope = cast_.measure();
    casters_.draw(objects_[i]);
  }
  map.castTarget.discardDepth();
  glDisable(GL_DEPTH_TEST);
}

void ContactShadow::blur(const Map& map) {
  const double texel = map.plan->texel();
  const double contactTexels = kContactReach / kContactHeight * map.contactHeight / texel;
  for (gpu::Program* program : {&blurAcross_, &blurDown_}) {
    const bool isFirst = program == &blurAcross_;
    program->use()
        .texture("map", isFirst ? map.heights : map.halfBlurred)
        .set("radiusTexels", glm::vec2(kSharpestTexels, kSoftness * map.plan->height / texel))
        .set("contactTexels", static_cast<float>(contactTexels))
        .set("contactHeight", static_cast<float>(map.contactHeight / map.plan->height));
    program->drawFullscreen(isFirst ? map.halfTarget : map.target);
  }
}

void ContactShadow::draw() {
  if (std::ranges::none_of(maps_, &Map::isShown)) return;
  glEnable(GL_BLEND);
  glBlendFunc(GL_ZERO, GL_SRC_COLOR);
  glDrawBuffers(3, kFirstAlone.data());
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(noAttributes_.get());
  for (const Map& map : maps_) {
    if (!map.isShown) continue;
    const ShadowPlan& plan = *map.plan;
    const float height = std::max(glm::dot(map.light.towardKey, map.light.up), 0.0F);
    const glm::vec3 white = glm::max(map.light.white, 1e-3F);
    const glm::vec3 key = glm::min(height * map.light.key / white, 1.0F);
    receive_.use()
        .texture("map", map.blurred)
        .set("cameraFromAttach", glm::mat4(map.cameraFromAttach))
        .set("square", glm::vec3(plan.centre, plan.half))
        .set("cells", kReceiverCells)
        .set("keyShare", scene_.light.shadow * key)
        .set("ambientShare", scene_.light.shadow * (1.0F - key));
    const gpu::PassTimer::Scope scope = receive_.measure();
    glDrawArrays(GL_TRIANGLES, 0, 6 * kReceiverCells * kReceiverCells);
  }
  glBindVertexArray(0);
  glDrawBuffers(3, kAll.data());
  glDisable(GL_BLEND);
}

}  // namespace pleinair::scene
