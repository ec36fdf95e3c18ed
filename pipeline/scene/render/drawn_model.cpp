#include "pipeline/scene/render/drawn_model.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/packing.hpp>
#include <meshoptimizer.h>

#include "pipeline/scene/models/declared_directions.h"
#include "pipeline/scene/models/surface_form.h"

namespace pleinair::scene {
namespace {

constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

RestVertex restVertex(const Mesh& mesh, std::size_t index, const ModelPart& part) {
  const MeshVertex& vertex = mesh.vertices[index];
  RestVertex rest{.position = vertex.position,
                  .firstMatrix = static_cast<std::uint32_t>(part.firstMatrix),
                  .normal = octahedral(vertex.normal)};
  // A shader must not read beyond the joints of the part, even if the mesh belongs to another skin.
  const bool isSkinned = part.skin.has_value() && !mesh.joints.empty();
  const JointWeights held = isSkinned ? mesh.joints[index] : JointWeights{};
  for (std::size_t i = 0; i < 4; ++i) {
    assert(held.joints[i] < part.matrixCount);
    rest.joints |= std::uint32_t{held.joints[i]} << (8 * i);
  }
  rest.weights = {glm::packUnorm2x16({held.weights[0], held.weights[1]}),
                  glm::packUnorm2x16({held.weights[2], held.weights[3]})};
  return rest;
}

VertexAttributes attributesOf(const MeshVertex& vertex) {
  return {.texture = vertex.texture,
          .colour = glm::u16vec4(65535.0F * glm::clamp(vertex.colour, 0.0F, 1.0F) + 0.5F)};
}

/// The triangles of a mirrored part have the opposite orientation.
bool isMirrored(const ModelPart& part) {
  return !part.skin && glm::determinant(glm::dmat3(part.modelFromPart)) < 0.0;
}

/// For each vertex the first one equal to it. Generated meshes often have one vertex per corner;
/// equal vertices that move differently stay separate.
std::vector<std::uint32_t> firstEqualVertices(const Mesh& mesh) {
  static_assert(sizeof(MeshVertex) == 12 * sizeof(float));  // all bytes are compared
  const std::size_t count = mesh.vertices.size();
  std::vector<std::uint32_t> alike(count);
  std::iota(alike.begin(), alike.end(), 0U);
  if (count == 0 || !mesh.joints.empty() || !mesh.morphTargets.empty()) return alike;
  const std::size_t different = meshopt_generateVertexRemap(
      alike.data(), nullptr, count, mesh.vertices.data(), count, sizeof(MeshVertex));
  std::vector<std::uint32_t> first(different, kNoVertex);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t& known = first[alike[i]];
    if (known == kNoVertex) known = static_cast<std::uint32_t>(i);
    alike[i] = known;
  }
  return alike;
}

/// Rotates each triangle, if possible, so that its last vertex is the last vertex of no other.
std::vector<std::array<std::uint32_t, 3>> withOwnLastVertices(const Mesh& mesh, bool mirrored) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangles.reserve(mesh.triangles.size());
  std::vector<bool> isTaken(mesh.vertices.size(), false);
  const std::vector<std::uint32_t> alike = firstEqualVertices(mesh);
  for (std::array<std::uint32_t, 3> corners : mesh.triangles) {
    for (std::uint32_t& corner : corners) corner = alike[corner];
    if (mirrored) std::swap(corners[0], corners[1]);
    const auto free =
        std::ranges::find(corners, false, [&](std::uint32_t v) { return isTaken[v]; });
    if (free != corners.end()) std::rotate(corners.begin(), std::next(free), corners.end());
    isTaken[corners[2]] = true;
    triangles.push_back(corners);
  }
  return triangles;
}

/// Where DrawnForm has what.
constexpr unsigned kLineBit = 12;
constexpr unsigned kClarityBit = 24;
constexpr float kMostClarity = 31.0F;
constexpr std::uint32_t kOnLimb = 1U << 29U;
constexpr std::uint32_t kAtJoint = 1U << 30U;
constexpr std::uint32_t kDeclared = 1U << 31U;

/// `along` in the coordinates of a triangle's corners: a line and its clarity.
std::uint32_t drawnLine(const glm::vec3& along, const std::array<glm::vec3, 3>& corners) {
  const glm::vec3 a = corners[0] - corners[2];
  const glm::vec3 b = corners[1] - corners[2];
  // Least squares: `along` lies in the triangle's plane.
  const glm::mat2 sides(glm::dot(a, a), glm::dot(a, b), glm::dot(a, b), glm::dot(b, b));
  const float clarity = std::min(glm::length(along), 1.0F);
  if (clarity <= 0.0F || std::abs(glm::determinant(sides)) < 1e-30F) return 0;
  const glm::vec2 at = glm::inverse(sides) * glm::vec2(glm::dot(along, a), glm::dot(along, b));
  constexpr float kPi = std::numbers::pi_v<float>;
  float angle = std::atan2(at.y, at.x);
  if (angle < 0.0F) angle += kPi;
  return (static_cast<std::uint32_t>(std::lround(angle / kPi * 4096.0F)) & 0xFFFU) << kLineBit |
         static_cast<std::uint32_t>(std::lround(kMostClarity * clarity)) << kClarityBit;
}

/// Lays out a model, one surface of a part after another.
class Layout {
 public:
  Layout(const Model& model, DrawnModel& drawn)
      : model_(model), drawn_(drawn), nextExtra_(model.triangleCount()) {
    const std::uint32_t triangles = model.triangleCount();
    drawn_.rest.resize(triangles);
    drawn_.attributes.resize(triangles);
    drawn_.triangles.reserve(triangles);
    materials_.reserve(triangles);
  }

  void add(std::size_t partIndex, std::size_t surfaceIndex) {
    const ModelPart& part = model_.parts[partIndex];
    const Surface& surface = model_.surfaces[surfaceIndex];
    const auto triangles = withOwnLastVertices(surface.mesh, isMirrored(part));
    const std::vector<TriangleForm>& forms = formsOfSurface(surfaceIndex, part);
    const bool isDeclared = declaresDirections(model_, surface.mesh);
    std::vector<glm::vec3> declared;
    if (isDeclared) declared = declaredDirections(model_, part, surfaceIndex - part.firstSurface);
    const auto firstTriangle = static_cast<std::uint32_t>(drawn_.triangles.size());
    const std::uint32_t firstExtra = nextExtra_;
    source_.clear();
    place_.assign(surface.mesh.vertices.size(), kNoVertex);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      place_[triangles[i][2]] = firstTriangle + static_cast<std::uint32_t>(i);
    }
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const std::uint32_t number = firstTriangle + static_cast<std::uint32_t>(i);
      put(number, surface.mesh, triangles[i][2], part);
      drawn_.triangles.push_back({{placeOf(triangles[i][0], surface.mesh, part),
                                   placeOf(triangles[i][1], surface.mesh, part), number},
                                  static_cast<std::uint32_t>(partIndex)});
      std::array<glm::vec3, 3> corners{};
      for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = surface.mesh.vertices[triangles[i][k]].position;
      }
      drawn_.forms.push_back(((firstPatch_ + forms[i].patch) & 0xFFFU) |
                             drawnLine(isDeclared ? declared[i] : forms[i].along, corners) |
                             (forms[i].isOnLimb ? kOnLimb : 0U) |
                             (forms[i].isAtJoint ? kAtJoint : 0U) | (isDeclared ? kDeclared : 0U));
      materials_.push_back(surface.material);
    }
    for (const TriangleForm& form : forms) patches_ = std::max(patches_, firstPatch_ + form.patch);
    firstPatch_ = patches_ + 1;
    addRange(firstTriangle, static_cast<std::uint32_t>(triangles.size()), surface.mesh, part);
    addRange(firstExtra, nextExtra_ - firstExtra, surface.mesh, part);
  }

  void finish() {
    std::ranges::sort(drawn_.ranges, {}, &PoseRange::firstVertex);
    mergeRanges();
    makeBatches();
  }

 private:
  /// Parts may share surfaces.
  const std::vector<TriangleForm>& formsOfSurface(std::size_t index, const ModelPart& part) {
    const auto known = forms_.find({index, part.skin});
    if (known != forms_.end()) return known->second;
    std::vector<std::size_t> limbs;
    if (part.skin) limbs = limbsOf(model_.rig, model_.rig.skins[*part.skin]);
    return forms_[{index, part.skin}] = formsOf(model_.surfaces[index].mesh, limbs);
  }

  void put(std::uint32_t place, const Mesh& mesh, std::uint32_t vertex, const ModelPart& part) {
    drawn_.rest[place] = restVertex(mesh, vertex, part);
    drawn_.attributes[place] = attributesOf(mesh.vertices[vertex]);
    source_.emplace_back(place, vertex);
  }

  std::uint32_t placeOf(std::uint32_t vertex, const Mesh& mesh, const ModelPart& part) {
    std::uint32_t& place = place_[vertex];
    if (place == kNoVertex) {
      place = nextExtra_++;
      drawn_.rest.emplace_back();
      drawn_.attributes.emplace_back();
      put(place, mesh, vertex, part);
    }
    return place;
  }

  void addRange(std::uint32_t first, std::uint32_t count, const Mesh& mesh, const ModelPart& part) {
    if (count == 0) return;
    PoseRange range{.firstVertex = first, .vertexCount = count};
    if (!mesh.morphTargets.empty()) {
      range.targetCount = static_cast<std::uint32_t>(mesh.morphTargets.size());
      range.firstDelta = static_cast<std::uint32_t>(drawn_.deltas.size());
      range.firstWeight = static_cast<std::uint32_t>(part.firstWeight);
      addDeltas(range, mesh);
    }
    drawn_.ranges.push_back(range);
  }

  void addDeltas(const PoseRange& range, const Mesh& mesh) {
    drawn_.deltas.resize(drawn_.deltas.size() + std::size_t{range.targetCount} * range.vertexCount);
    for (std::size_t target = 0; target < mesh.morphTargets.size(); ++target) {
      const MorphTarget& morph = mesh.morphTargets[target];
      MorphDelta* row = &drawn_.deltas[range.firstDelta + target * range.vertexCount];
      for (const auto& [place, vertex] : source_) {
        if (place < range.firstVertex || place >= range.firstVertex + range.vertexCount) continue;
        MorphDelta& delta = row[place - range.firstVertex];
        delta.position = glm::vec4(morph.positions[vertex], 0.0F);
        if (!morph.normals.empty()) delta.normal = glm::vec4(morph.normals[vertex], 0.0F);
      }
    }
  }

  /// Adjacent ranges without morph targets become one.
  void mergeRanges() {
    std::vector<PoseRange> merged;
    for (const PoseRange& range : drawn_.ranges) {
      const bool joins =
          !merged.empty() && merged.back().targetCount == 0 && range.targetCount == 0;
      if (joins) {
        merged.back().vertexCount += range.vertexCount;
      } else {
        merged.push_back(range);
      }
    }
    drawn_.ranges = std::move(merged);
  }

  /// Sorts triangles by material; stable within a material.
  void makeBatches() {
    std::vector<std::uint32_t> order(drawn_.triangles.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return materials_[i]; });
    drawn_.indices.reserve(3 * order.size());
    for (const std::uint32_t number : order) {
      if (drawn_.batches.empty() || drawn_.batches.back().material != materials_[number]) {
        drawn_.batches.push_back({.material = materials_[number],
                                  .firstIndex = static_cast<std::uint32_t>(drawn_.indices.size())});
      }
      const auto& corners = drawn_.triangles[number].corners;
      drawn_.indices.insert(drawn_.indices.end(), corners.begin(), corners.end());
      drawn_.batches.back().indexCount += 3;
    }
  }

  const Model& model_;
  DrawnModel& drawn_;
  std::uint32_t nextExtra_;
  std::uint32_t firstPatch_ = 0;
  std::uint32_t patches_ = 0;
  std::map<std::pair<std::size_t, std::optional<std::size_t>>, std::vector<TriangleForm>> forms_;
  std::vector<std::size_t> materials_;                           // per triangle
  std::vector<std::uint32_t> place_;                             // per vertex of the surface
  std::vector<std::pair<std::uint32_t, std::uint32_t>> source_;  // place, and vertex of the surface
};

}  // namespace

DrawnModel::DrawnModel(const Model& model) {
  Layout layout(model, *this);
  for (std::size_t part = 0; part < model.parts.size(); ++part) {
    for (std::size_t i = 0; i < model.parts[part].surfaceCount; ++i) {
      layout.add(part, model.parts[part].firstSurface + i);
    }
  }
  layout.finish();
}

std::uint32_t octahedral(const glm::vec3& unit) {
  const float sum = std::abs(unit.x) + std::abs(unit.y) + std::abs(unit.z);
  if (!(sum > 0.0F)) return glm::packSnorm2x16({0.0F, 0.0F});
  glm::vec2 flat = glm::vec2(unit) / sum;
  if (unit.z < 0.0F) {
    flat = glm::vec2((1.0F - std::abs(flat.y)) * (flat.x < 0.0F ? -1.0F : 1.0F),
                     (1.0F - std::abs(flat.x)) * (flat.y < 0.0F ? -1.0F : 1.0F));
  }
  return glm::packSnorm2x16(flat);
}

}  // namespace pleinair::scene
