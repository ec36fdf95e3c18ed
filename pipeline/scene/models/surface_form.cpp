#include "pipeline/scene/models/surface_form.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace pleinair::scene {
namespace {

/// Cosine of the angle between triangles from which an edge is a crease.
constexpr float kCreaseCosine = 0.64F;  // 50°
/// Patches below this part of the area of the connected surface join a neighbour: a gear's teeth.
constexpr double kSmallPatch = 0.03;
constexpr int kSmoothing = 2;  // rounds over which curvatures are averaged with neighbours'
/// Curvature times the radius of the mesh at which a direction begins to count, and counts fully.
constexpr float kFaint = 0.2F;
constexpr float kClear = 0.8F;

/// A chain of joints counts as a limb from this part of the skeleton's longest chain on; fingers do
/// not.
constexpr double kLimb = 0.2;

using Corners = std::array<std::uint32_t, 3>;

/// Disjoint sets of triangles.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t of(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = of(a);
    b = of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

struct PlaceHash {
  std::size_t operator()(const glm::vec3& p) const {
    std::size_t hash = 0;
    for (int i = 0; i < 3; ++i) {
      hash = hash * 0x9E3779B97F4A7C15U + std::bit_cast<std::uint32_t>(p[i] + 0.0F);
    }
    return hash ^ (hash >> 32U);
  }
};

/// Triangles whose corners are places: vertices at one position are one place.
struct Welded {
  explicit Welded(const Mesh& mesh) {
    std::unordered_map<glm::vec3, std::uint32_t, PlaceHash> known;
    std::vector<std::uint32_t> placeOf;
    for (const MeshVertex& vertex : mesh.vertices) {
      const auto [at, isNew] =
          known.try_emplace(vertex.position, static_cast<std::uint32_t>(places.size()));
      if (isNew) places.push_back(vertex.position);
      placeOf.push_back(at->second);
    }
    for (const Corners& corners : mesh.triangles) {
      triangles.push_back({placeOf[corners[0]], placeOf[corners[1]], placeOf[corners[2]]});
    }
  }
  std::vector<glm::vec3> places;
  std::vector<Corners> triangles;
};

/// Twice the area along the normal.
glm::vec3 areaVector(const Welded& mesh, std::size_t triangle) {
  const Corners& c = mesh.triangles[triangle];
  return glm::cross(mesh.places[c[1]] - mesh.places[c[0]], mesh.places[c[2]] - mesh.places[c[0]]);
}

glm::vec3 unitOf(const glm::vec3& v) {
  const float length = glm::length(v);
  return length > 0.0F ? v / length : glm::vec3(0.0F);
}

/// Two triangles that share an edge.
struct Neighbours {
  std::size_t a = 0;
  std::size_t b = 0;
  float edge = 0.0F;  // length
};

/// At an edge of more than two triangles, each with the one before.
std::vector<Neighbours> neighboursOf(const Welded& mesh) {
  std::unordered_map<std::uint64_t, std::size_t> last;
  last.reserve(2 * mesh.triangles.size());
  std::vector<Neighbours> all;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t side = 0; side < 3; ++side) {
      const std::uint32_t p = mesh.triangles[i][side];
      const std::uint32_t q = mesh.triangles[i][(side + 1) % 3];
      if (p == q) continue;
      const std::uint64_t edge = std::uint64_t{std::min(p, q)} << 32U | std::max(p, q);
      const auto [at, isFirst] = last.try_emplace(edge, i);
      if (isFirst) continue;
      all.push_back({at->second, i, glm::distance(mesh.places[p], mesh.places[q])});
      at->second = i;
    }
  }
  return all;
}

/// The limb that holds most of each triangle; all 0 without limbs.
std::vector<std::size_t> limbsOfTriangles(const Mesh& mesh, std::span<const std::size_t> limbs) {
  std::vector<std::size_t> found(mesh.triangles.size(), 0);
  if (limbs.empty() || mesh.joints.empty()) return found;
  for (std::size_t i = 0; i < found.size(); ++i) {
    std::map<std::size_t, float> held;
    for (const std::uint32_t corner : mesh.triangles[i]) {
      const JointWeights& weights = mesh.joints[corner];
      for (std::size_t k = 0; k < 4; ++k) {
        if (weights.joints[k] < limbs.size()) held[limbs[weights.joints[k]]] += weights.weights[k];
      }
    }
    const auto most = std::ranges::max_element(held, {}, [](const auto& e) { return e.second; });
    if (most != held.end()) found[i] = most->first;
  }
  return found;
}

/// Joins small patches to the neighbour of the same limb with which they share the longest border,
/// the smallest first.
void joinSmallPatches(Sets& patches, const std::vector<double>& areas,
                      const std::vector<Neighbours>& neighbours,
                      const std::vector<std::size_t>& limbs) {
  Sets connected(areas.size());
  for (const Neighbours& each : neighbours) connected.join(each.a, each.b);
  std::unordered_map<std::size_t, double> wholes;
  for (std::size_t i = 0; i < areas.size(); ++i) wholes[connected.of(i)] += areas[i];
  const auto limitOf = [&](std::size_t triangle) {
    return kSmallPatch * wholes[connected.of(triangle)];
  };
  for (int round = 0; round < 16; ++round) {
    std::unordered_map<std::size_t, double> sizes;
    for (std::size_t i = 0; i < areas.size(); ++i) sizes[patches.of(i)] += areas[i];
    std::map<std::pair<std::size_t, std::size_t>, double> borders;  // of small ones with others
    for (const Neighbours& each : neighbours) {
      const std::size_t a = patches.of(each.a);
      const std::size_t b = patches.of(each.b);
      if (a == b || limbs[each.a] != limbs[each.b]) continue;
      if (sizes[a] < limitOf(a)) borders[{a, b}] += static_cast<double>(each.edge);
      if (sizes[b] < limitOf(b)) borders[{b, a}] += static_cast<double>(each.edge);
    }
    std::map<std::size_t, std::pair<double, std::size_t>> best;  // border, neighbour
    for (const auto& [pair, length] : borders) {
      auto& found = best[pair.first];
      if (length > found.first) found = {length, pair.second};
    }
    if (best.empty()) return;
    std::vector<std::tuple<double, std::size_t, std::size_t>> order;
    order.reserve(best.size());
    for (const auto& [patch, found] : best) {
      order.emplace_back(sizes[patch], patch, found.second);
    }
    std::ranges::sort(order);
    for (const auto& [size, patch, neighbour] : order) {
      if (sizes[patches.of(patch)] >= limitOf(patch)) continue;  // it has grown in this round
      const std::size_t a = patches.of(patch);
      const std::size_t b = patches.of(neighbour);
      if (a == b) continue;
      const double joined = sizes[a] + sizes[b];
      patches.join(a, b);
      sizes[patches.of(a)] = joined;
    }
  }
}

/// The triangles that touch a border between trunk and limb on a smooth surface, and belong to the
/// patches on both sides of it.
std::vector<bool> trianglesAtJoints(const Welded& mesh, const std::vector<Neighbours>& neighbours,
                                    const std::vector<std::size_t>& limbOf,
                                    const std::vector<glm::vec3>& areaVectors, Sets& patches) {
  std::vector<bool> found(mesh.triangles.size(), false);
  std::set<std::pair<std::uint32_t, std::size_t>> touched;  // place and patch
  for (const Neighbours& each : neighbours) {
    if ((limbOf[each.a] == 0) == (limbOf[each.b] == 0)) continue;
    const float cosine = glm::dot(unitOf(areaVectors[each.a]), unitOf(areaVectors[each.b]));
    if (!(cosine > kCreaseCosine)) continue;
    for (const std::uint32_t place : mesh.triangles[each.a]) {
      const Corners& other = mesh.triangles[each.b];
      if (std::ranges::find(other, place) == other.end()) continue;
      touched.emplace(place, patches.of(each.a));
      touched.emplace(place, patches.of(each.b));
    }
  }
  if (touched.empty()) return found;
  for (std::size_t i = 0; i < found.size(); ++i) {
    found[i] = std::ranges::any_of(mesh.triangles[i], [&](std::uint32_t place) {
      return touched.contains({place, patches.of(i)});
    });
  }
  return found;
}

/// From the change of the normals along a triangle's edges: the second fundamental form as a tensor
/// in space.
glm::mat3 curvatureOf(const std::array<glm::vec3, 3>& places,
                      const std::array<glm::vec3, 3>& normals) {
  const glm::vec3 u = unitOf(places[1] - places[0]);
  const glm::vec3 n = unitOf(glm::cross(places[1] - places[0], places[2] - places[0]));
  const glm::vec3 v = glm::cross(n, u);
  // Least squares of (e f; f g) · edge = change of normal, three edges.
  glm::mat3 normal(0.0F);
  glm::vec3 right(0.0F);
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::vec3 edge = places[(i + 2) % 3] - places[(i + 1) % 3];
    const glm::vec3 change = normals[(i + 2) % 3] - normals[(i + 1) % 3];
    const glm::vec2 along(glm::dot(edge, u), glm::dot(edge, v));
    const std::array<glm::vec3, 2> rows{glm::vec3(along.x, along.y, 0.0F),
                                        glm::vec3(0.0F, along.x, along.y)};
    const std::array<float, 2> values{glm::dot(change, u), glm::dot(change, v)};
    for (std::size_t r = 0; r < 2; ++r) {
      normal += glm::outerProduct(rows[r], rows[r]);
      right += values[r] * rows[r];
    }
  }
  const float scale = normal[0][0] + normal[1][1] + normal[2][2];
  if (!(std::abs(glm::determinant(normal)) > 1e-9F * scale * scale * scale)) {
    return glm::mat3(0.0F);
  }
  const glm::vec3 form = glm::inverse(normal) * right;
  return form.x * glm::outerProduct(u, u) +
         form.y * (glm::outerProduct(u, v) + glm::outerProduct(v, u)) +
         form.z * glm::outerProduct(v, v);
}

/// The direction of least curvature in the plane across `n`, as TriangleForm::along.
glm::vec3 leastCurved(const glm::mat3& curvature, const glm::vec3& n, float radius) {
  const glm::vec3 u =
      unitOf(glm::cross(n, std::abs(n.x) < 0.7F ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
  const glm::vec3 v = glm::cross(n, u);
  const float e = glm::dot(u, curvature * u);
  const float f = glm::dot(u, curvature * v);
  const float g = glm::dot(v, curvature * v);
  const float mean = 0.5F * (e + g);
  const float spread = std::hypot(0.5F * (e - g), f);
  const float high = std::abs(mean + spread);
  const float low = std::abs(mean - spread);
  const float most = std::max(high, low);
  if (most <= 0.0F) return glm::vec3(0.0F);
  // The eigenvector of mean + spread lies at this angle; the other one is across it.
  const float angle = 0.5F * std::atan2(2.0F * f, e - g);
  const glm::vec3 first = std::cos(angle) * u + std::sin(angle) * v;
  const glm::vec3 along = high < low ? first : glm::cross(n, first);
  const float t = std::clamp((most * radius - kFaint) / (kClear - kFaint), 0.0F, 1.0F);
  return std::abs(high - low) / (high + low) * t * t * (3.0F - 2.0F * t) * along;
}

}  // namespace

std::vector<TriangleForm> formsOf(const Mesh& mesh, std::span<const std::size_t> limbs) {
  const Welded welded(mesh);
  const std::size_t count = welded.triangles.size();
  const std::vector<Neighbours> neighbours = neighboursOf(welded);
  const std::vector<std::size_t> limbOf = limbsOfTriangles(mesh, limbs);
  std::vector<glm::vec3> areaVectors(count);
  std::vector<double> areas(count);
  for (std::size_t i = 0; i < count; ++i) {
    areaVectors[i] = areaVector(welded, i);
    areas[i] = static_cast<double>(glm::length(areaVectors[i]));
  }
  Sets patches(count);
  for (const Neighbours& each : neighbours) {
    const float cosine = glm::dot(unitOf(areaVectors[each.a]), unitOf(areaVectors[each.b]));
    if (cosine > kCreaseCosine && limbOf[each.a] == limbOf[each.b]) patches.join(each.a, each.b);
  }

  const std::vector<bool> isAtJoint =
      trianglesAtJoints(welded, neighbours, limbOf, areaVectors, patches);

  // Smooth vertices: one for each patch at a place.
  std::unordered_map<std::uint64_t, std::uint32_t> known;
  std::vector<Corners> corners(count);
  std::vector<glm::vec3> normals;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t key = std::uint64_t{patches.of(i)} << 32U | welded.triangles[i][k];
      const auto [at, isNew] = known.try_emplace(key, static_cast<std::uint32_t>(normals.size()));
      if (isNew) normals.emplace_back(0.0F);
      corners[i][k] = at->second;
      normals[at->second] += areaVectors[i];
    }
  }
  for (glm::vec3& normal : normals) normal = unitOf(normal);
  std::vector<glm::mat3> curvatures(count, glm::mat3(0.0F));
  for (std::size_t i = 0; i < count; ++i) {
    std::array<glm::vec3, 3> places{};
    std::array<glm::vec3, 3> ends{};
    for (std::size_t k = 0; k < 3; ++k) {
      places[k] = welded.places[welded.triangles[i][k]];
      ends[k] = normals[corners[i][k]];
    }
    curvatures[i] = curvatureOf(places, ends);
  }
  for (int round = 0; round < kSmoothing; ++round) {
    std::vector<glm::mat3> sums(normals.size(), glm::mat3(0.0F));
    std::vector<float> weights(normals.size(), 0.0F);
    for (std::size_t i = 0; i < count; ++i) {
      for (const std::uint32_t corner : corners[i]) {
        sums[corner] += static_cast<float>(areas[i]) * curvatures[i];
        weights[corner] += static_cast<float>(areas[i]);
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      glm::mat3 mean(0.0F);
      for (const std::uint32_t corner : corners[i]) {
        if (weights[corner] > 0.0F) mean += sums[corner] / (3.0F * weights[corner]);
      }
      curvatures[i] = mean;
    }
  }

  joinSmallPatches(patches, areas, neighbours, limbOf);
  const auto radius = static_cast<float>(boundingSphere(mesh).radiusMetres);
  std::unordered_map<std::size_t, std::uint32_t> numbers;
  std::vector<TriangleForm> forms(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto next = static_cast<std::uint32_t>(numbers.size());
    forms[i].patch = numbers.try_emplace(patches.of(i), next).first->second;
    forms[i].isOnLimb = limbOf[i] != 0;
    forms[i].isAtJoint = isAtJoint[i];
    forms[i].along = leastCurved(curvatures[i], unitOf(areaVectors[i]), radius);
  }
  return forms;
}

std::vector<std::size_t> limbsOf(const Rig& rig, const Skin& skin) {
  const std::size_t count = rig.nodes.size();
  std::vector<bool> isJoint(count, false);
  for (const std::size_t node : skin.joints) isJoint[node] = true;
  const auto parentOf = [&](std::size_t node) -> std::optional<std::size_t> {
    const auto& parent = rig.nodes[node].parent;
    return isJoint[node] && parent && isJoint[*parent] ? parent : std::nullopt;
  };
  // The length of the longest chain from a joint's parent through it to an end.
  std::vector<double> reach(count, 0.0);
  for (std::size_t i = count; i-- > 0;) {  // parents come before their children
    const RigNode& node = rig.nodes[i];
    const glm::dmat4 place = node.parentFromNode.value_or(parentFromNode(node.rest));
    const auto parent = parentOf(i);
    if (!parent) continue;
    reach[i] += glm::length(glm::dvec3(place[3]));
    reach[*parent] = std::max(reach[*parent], reach[i]);
  }
  double longest = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!parentOf(i)) longest = std::max(longest, reach[i]);
  }
  const auto isLong = [&](std::size_t node) { return reach[node] >= kLimb * longest; };
  std::vector<std::size_t> chains(count, 0);  // long ones below each joint
  for (std::size_t i = 0; i < count; ++i) {
    if (const auto parent = parentOf(i); parent && isLong(i)) ++chains[*parent];
  }
  std::vector<bool> branches(count, false);  // at the joint or below it
  for (std::size_t i = count; i-- > 0;) {
    branches[i] = branches[i] || chains[i] >= 2;
    if (const auto parent = parentOf(i); parent && branches[i]) branches[*parent] = true;
  }
  constexpr std::size_t kTrunk = 0;
  std::vector<std::size_t> limb(count, kTrunk);
  std::size_t next = kTrunk + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const auto parent = parentOf(i);
    if (!parent) continue;
    const bool begins =
        limb[*parent] == kTrunk && chains[*parent] >= 2 && isLong(i) && !branches[i];
    limb[i] = begins ? next++ : limb[*parent];
  }
  std::vector<std::size_t> limbs;
  limbs.reserve(skin.joints.size());
  for (const std::size_t node : skin.joints) limbs.push_back(limb[node]);
  return limbs;
}

}  // namespace pleinair::scene
