#include "pipeline/scene/render/shadow_casters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "pipeline/scene/models/model_pose.h"

namespace pleinair::scene {
namespace {

constexpr double kMaxShear = 1.6;     // a key light below 32° is raised to that angle
constexpr double kMaxDistance = 2.0;  // of a caster from the plane, in radii
constexpr double kMargin = 1.2;       // for the penumbra
constexpr double kBelow = 0.03;  // part of the height below the plane that still casts a shadow
constexpr double kStepsADoubling = 4.0;

struct Bounds {
  glm::dvec2 low{HUGE_VAL};
  glm::dvec2 high{-HUGE_VAL};

  void add(const glm::dvec2& centre, const glm::dvec2& reach) {
    low = glm::min(low, centre - reach);
    high = glm::max(high, centre + reach);
  }
};

bool contains(const ShadowPlan& plan, const Bounds& bounds) {
  return glm::all(glm::greaterThanEqual(bounds.low, plan.centre - plan.half)) &&
         glm::all(glm::lessThanEqual(bounds.high, plan.centre + plan.half));
}

}  // namespace

glm::dmat4 ShadowPlan::mapFromAttach() const {
  const double below = kBelow * height;
  glm::dmat4 map(1.0);
  map[0][0] = 1.0 / half;
  map[1][1] = 1.0 / half;
  map[2] = glm::dvec4(shear / half, 2.0 / (height + below), 0.0);
  map[3] = glm::dvec4(-centre / half, 2.0 * below / (height + below) - 1.0, 1.0);
  return map;
}

std::optional<ShadowPlan> planShadow(std::span<const BoundingSphere> spheres,
                                     const glm::dvec3& towardKey,
                                     const std::optional<ShadowPlan>& before) {
  ShadowPlan plan;
  const double up = std::max(towardKey.z, 1e-3);
  plan.shear = -glm::dvec2(towardKey) / up;
  const double shear = glm::length(plan.shear);
  if (shear > kMaxShear) plan.shear *= kMaxShear / shear;
  Bounds bounds;
  for (const BoundingSphere& sphere : spheres) {
    const double r = sphere.radiusMetres;
    const bool isNear =
        sphere.centre.z - r < kMaxDistance * r && sphere.centre.z + r > 0.0 && r > 0.0;
    if (!isNear) continue;
    const glm::dvec2 foot(sphere.centre);
    bounds.add(foot, glm::dvec2(r));
    bounds.add(foot + std::max(sphere.centre.z, 0.0) * plan.shear,
               r * glm::sqrt(1.0 + plan.shear * plan.shear));
    plan.height = std::max(plan.height, sphere.centre.z + r);
  }
  if (!(plan.height > 0.0)) return std::nullopt;
  const glm::dvec2 extent = 0.5 * kMargin * (bounds.high - bounds.low);
  const double half = std::max(extent.x, extent.y);
  const bool fits = before && contains(*before, bounds) && before->half < 1.5 * half &&
                    before->height >= plan.height && before->height < 1.5 * plan.height;
  if (fits) {
    plan.half = before->half;
    plan.centre = before->centre;
    plan.height = before->height;
    return plan;
  }
  plan.height = std::exp2(std::ceil(kStepsADoubling * std::log2(plan.height)) / kStepsADoubling);
  plan.half = std::exp2(std::ceil(kStepsADoubling * std::log2(half)) / kStepsADoubling);
  plan.centre = plan.texel() * glm::round(0.5 * (bounds.low + bounds.high) / plan.texel());
  return plan;
}

namespace {

constexpr double kCellOfRadius = 1.0 / 28.0;  // about a texel of a shadow's map
constexpr float kMaxCell = 1e9F;              // limit up to which a cell index fits an integer
constexpr std::size_t kPosedBytes = 16;

/// Position of a vertex at rest, by its strongest joint.
glm::vec3 atRest(const RestVertex& vertex, const ModelPose& pose) {
  const std::array<std::uint32_t, 4> weights{vertex.weights[0] & 0xFFFFU, vertex.weights[0] >> 16U,
                                             vertex.weights[1] & 0xFFFFU, vertex.weights[1] >> 16U};
  const auto most = static_cast<unsigned>(std::ranges::max_element(weights) - weights.begin());
  const std::uint32_t joint = (vertex.joints >> (8U * most)) & 0xFFU;
  const glm::dmat4& matrix = pose.matrices[vertex.firstMatrix + joint];
  return glm::vec3(matrix * glm::dvec4(vertex.position, 1.0));
}

std::vector<glm::vec3> restOf(const DrawnModel& drawn, const Model& model) {
  ModelPose pose;
  poseModel(model, std::nullopt, {}, pose);
  std::vector<glm::vec3> rest;
  rest.reserve(drawn.rest.size());
  for (const RestVertex& vertex : drawn.rest) rest.push_back(atRest(vertex, pose));
  return rest;
}

}  // namespace

std::vector<std::uint32_t> coarseTriangles(const DrawnModel& drawn,
                                           const std::vector<glm::vec3>& rest, double cellMetres) {
  using Cell = std::tuple<std::uint32_t, std::uint32_t, int, int, int>;
  std::map<Cell, std::uint32_t> representatives;
  std::vector<std::uint32_t> representative(rest.size());
  for (std::uint32_t i = 0; i < rest.size(); ++i) {
    const glm::vec3 cells = glm::floor(rest[i] / static_cast<float>(cellMetres));
    const glm::ivec3 at(glm::clamp(cells, -kMaxCell, kMaxCell));
    const RestVertex& vertex = drawn.rest[i];
    const Cell cell{vertex.firstMatrix, vertex.joints & 0xFFU, at.x, at.y, at.z};
    representative[i] = representatives.try_emplace(cell, i).first->second;
  }
  std::set<std::array<std::uint32_t, 3>> known;
  std::vector<std::uint32_t> indices;
  for (const DrawnTriangle& triangle : drawn.triangles) {
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) corners[i] = representative[triangle.corners[i]];
    std::ranges::sort(corners);
    if (corners[0] == corners[1] || corners[1] == corners[2]) continue;
    if (known.insert(corners).second) indices.insert(indices.end(), corners.begin(), corners.end());
  }
  return indices;
}

ShadowCasters::ShadowCasters(const Scene& scene, const PosedGeometry& geometry)
    : geometry_(geometry) {
  std::vector<std::uint32_t> indices;
  for (const SceneModel& sceneModel : scene.models) {
    const Model* model = sceneModel.isOccluder ? nullptr : sceneModel.model.get();
    const auto knownSlot = std::ranges::find(slots_, model, &Slot::model);
    slotOf_.push_back(static_cast<std::size_t>(knownSlot - slots_.begin()));
    if (knownSlot != slots_.end()) continue;
    Slot& slot = slots_.emplace_back(Slot{.model = model, .firstIndex = indices.size()});
    if (model == nullptr || model->triangleCount() == 0) continue;
    const DrawnModel drawn(*model);
    const double cell = kCellOfRadius * boundingSphere(*model).radiusMetres;
    const auto coarse = coarseTriangles(drawn, restOf(drawn, *model), std::max(cell, 1e-9));
    slot.indexCount = coarse.size();
    indices.insert(indices.end(), coarse.begin(), coarse.end());
  }
  if (indices.empty()) return;
  indices_ = gpu::Buffer::of(std::span<const std::uint32_t>(indices));
  vertexArray_ = gpu::VertexArrayHandle::make();
  glBindVertexArray(vertexArray_.get());
  glVertexAttribFormat(0, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexAttribBinding(0, 0);
  glEnableVertexAttribArray(0);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
  glBindVertexArray(0);
}

void ShadowCasters::draw(std::size_t object) const {
  const Slot& slot = slots_[slotOf_[object]];
  glBindVertexArray(vertexArray_.get());
  glBindVertexBuffer(
      0, geometry_.posed().name(),
      static_cast<GLintptr>(kPosedBytes * std::size_t{geometry_.place(object).firstCurrent}),
      kPosedBytes);
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(slot.indexCount), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(slot.firstIndex * sizeof(std::uint32_t)));
  glBindVertexArray(0);
}

}  // namespace pleinair::scene
