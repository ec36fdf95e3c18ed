#include "tests/gpu/scene/moving_models.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "pipeline/scene/builtin/builtin_box.h"

namespace pleinair::scene {
namespace {

Channel rotationAbout(std::size_t node, glm::dvec3 axis, double angle) {
  Channel channel{.node = node, .property = AnimatedProperty::kRotation, .width = 4};
  for (const double at : {0.0, 1.0}) {
    channel.seconds.push_back(static_cast<float>(at));
    const glm::dquat q = glm::angleAxis(at * angle, glm::normalize(axis));
    for (const double value : {q.x, q.y, q.z, q.w}) {
      channel.values.push_back(static_cast<float>(value));
    }
  }
  return channel;
}

Channel linear(std::size_t node, AnimatedProperty property, std::size_t width,
               std::vector<float> values) {
  return {.node = node,
          .property = property,
          .seconds = {0.0F, 1.0F},
          .values = std::move(values),
          .width = width};
}

}  // namespace

Model turningGears() {
  Model model = singlePartModel("left", boxMesh({0.12, 0.12, 0.04}));
  model.parts[0].modelFromPart = glm::translate(glm::dmat4(1.0), {-0.07, 0.0, 0.0});
  model.parts[0].radiansPerSecond = 2.0;
  model.parts.push_back(model.parts[0]);
  model.parts[1].name = "right";
  model.parts[1].modelFromPart =
      glm::scale(glm::translate(glm::dmat4(1.0), {0.07, 0.0, 0.0}), {-1.0, 1.0, 1.0});
  numberParts(model);
  return model;
}

Model swingingBoxes() {
  Model model;
  model.surfaces.push_back({.mesh = boxMesh({0.1, 0.1, 0.06})});
  model.materials.emplace_back();
  model.rig.nodes = {{},
                     {.parent = 0, .rest = {.translation = {-0.07, 0.0, 0.0}}},
                     {.parent = 0, .rest = {.translation = {0.07, 0.0, 0.0}}}};
  model.rig.clips.push_back({.name = "swing", .seconds = 1.0});
  auto& channels = model.rig.clips[0].channels;
  channels.push_back(rotationAbout(0, {0.2, 0.1, 1.0}, 1.2));
  channels.push_back(rotationAbout(1, {1.0, 0.0, 0.3}, -2.0));
  channels.push_back(linear(2, AnimatedProperty::kScale, 3, {1.0F, 1.0F, 1.0F, 1.6F, 0.7F, 1.2F}));
  for (const std::size_t node : {1U, 2U}) {
    model.parts.push_back(
        {.name = node == 1U ? "one" : "two",
         .surfaceCount = 1,
         .modelFromPart = glm::translate(glm::dmat4(1.0), model.rig.nodes[node].rest.translation),
         .node = node});
  }
  numberParts(model);
  return model;
}

Model bendingArm() {
  constexpr int kRings = 17;
  constexpr int kSides = 12;
  Mesh mesh;
  for (int ring = 0; ring < kRings; ++ring) {
    const float along = static_cast<float>(ring) / (kRings - 1);
    for (int side = 0; side < kSides; ++side) {
      const double angle = 2.0 * std::numbers::pi * side / kSides;
      const glm::vec3 normal(0.0F, std::cos(angle), std::sin(angle));
      mesh.vertices.push_back(
          {.position = glm::vec3(0.24F * along - 0.12F, 0.0F, 0.0F) + 0.045F * normal,
           .normal = normal});
      const float bent = glm::smoothstep(0.3F, 0.7F, along);
      mesh.joints.push_back({.joints = {0, 1, 0, 0}, .weights = {1.0F - bent, bent, 0.0F, 0.0F}});
      if (ring == 0) continue;
      const auto at = [&](int r, int s) {
        return static_cast<std::uint32_t>(r * kSides + s % kSides);
      };
      mesh.triangles.push_back({at(ring - 1, side), at(ring, side), at(ring, side + 1)});
      mesh.triangles.push_back({at(ring - 1, side), at(ring, side + 1), at(ring - 1, side + 1)});
    }
  }
  // counter-clockwise as seen from outside
  for (auto& triangle : mesh.triangles) {
    const auto& [a, b, c] = triangle;
    const glm::vec3 normal = glm::cross(mesh.vertices[b].position - mesh.vertices[a].position,
                                        mesh.vertices[c].position - mesh.vertices[a].position);
    if (glm::dot(normal, mesh.vertices[a].normal) < 0.0F) std::swap(triangle[1], triangle[2]);
  }
  Model model;
  model.surfaces.push_back({.mesh = std::move(mesh)});
  model.materials.emplace_back();
  model.rig.nodes = {{.rest = {.translation = {-0.12, 0.0, 0.0}}},
                     {.parent = 0, .rest = {.translation = {0.12, 0.0, 0.0}}}};
  model.rig.skins.push_back(
      {.joints = {0, 1},
       .jointFromMesh = {glm::translate(glm::dmat4(1.0), {0.12, 0.0, 0.0}), glm::dmat4(1.0)}});
  model.rig.clips.push_back({.name = "bend", .seconds = 1.0});
  model.rig.clips[0].channels.push_back(rotationAbout(1, {0.1, 0.3, 1.0}, 1.8));
  model.rig.clips[0].channels.push_back(rotationAbout(0, {1.0, 0.0, 0.0}, 0.9));
  model.parts.push_back({.name = "arm", .surfaceCount = 1, .node = 0, .skin = 0});
  numberParts(model);
  return model;
}

Model breathingBall() {
  Mesh mesh = withShortEdges(boxMesh({0.16, 0.16, 0.16}), 0.03F);
  mesh.morphTargets.resize(2);
  for (MeshVertex& vertex : mesh.vertices) {
    const glm::vec3 p = vertex.position - glm::vec3(0.0F, 0.0F, 0.08F);
    const glm::vec3 round = glm::normalize(p);
    mesh.morphTargets[0].positions.push_back(0.09F * round - p);
    mesh.morphTargets[0].normals.push_back(round - vertex.normal);
    mesh.morphTargets[1].positions.push_back({0.1F * p.z, 0.0F, 0.3F * p.x * p.x});
  }
  Model model;
  model.surfaces.push_back({.mesh = std::move(mesh)});
  model.materials.emplace_back();
  model.rig.nodes = {{.weights = {0.0F, 0.0F}}};
  model.rig.clips.push_back({.name = "breathe", .seconds = 1.0});
  model.rig.clips[0].channels.push_back(
      linear(0, AnimatedProperty::kWeights, 2, {0.0F, 1.0F, 1.0F, -1.0F}));
  model.rig.clips[0].channels.push_back(
      linear(0, AnimatedProperty::kTranslation, 3, {0.0F, 0.0F, 0.0F, 0.1F, -0.05F, 0.04F}));
  model.parts.push_back({.name = "ball", .surfaceCount = 1, .node = 0});
  numberParts(model);
  return model;
}

}  // namespace pleinair::scene
