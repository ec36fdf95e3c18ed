#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include <glm/ext/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene/builtin/builtin_box.h"
#include "pipeline/scene/description/scene.h"

namespace pleinair::support {

/// Whether the boxes of wallOfBoxes() are models of their own or one model.
enum class Parts { kApart, kJoined };

/// A wall of `across` × `down` boxes of 2 cm that stand side by side, each turned and deep by its
/// own, around the origin and facing the camera of a world at z < 0.
inline scene::Scene wallOfBoxes(int across, int down, Parts parts, bool isReal = false) {
  constexpr double kSide = 0.02;
  scene::Scene scene;
  scene.light.shadow = 0.0F;
  scene::Mesh joined;
  const auto add = [&](scene::Mesh mesh, const glm::dmat4& place) {
    scene::SceneModel placed;
    placed.model =
        std::make_shared<const scene::Model>(scene::singlePartModel("boxes", std::move(mesh)));
    placed.attachFromModel = place;
    placed.isOccluder = isReal;
    scene.models.push_back(std::move(placed));
  };
  for (int i = 0; i < across * down; ++i) {
    const double x = kSide * (i % across - 0.5 * (across - 1));
    const double y = kSide * (i / across - 0.5 * (down - 1));
    const double deep = 0.02 + 0.01 * std::sin(1.7 * i);
    scene::Mesh mesh = scene::boxMesh({1.1 * kSide, 1.1 * kSide, deep});
    const glm::dmat4 place =
        glm::rotate(glm::translate(glm::dmat4(1.0), {x, y, 0.0}), 0.9 * i, {0.0, 0.0, 1.0});
    if (parts == Parts::kApart) {
      add(std::move(mesh), place);
      continue;
    }
    const auto first = static_cast<std::uint32_t>(joined.vertices.size());
    for (scene::MeshVertex vertex : mesh.vertices) {
      vertex.position = glm::vec3(place * glm::dvec4(vertex.position, 1.0));
      vertex.normal = glm::vec3(place * glm::dvec4(vertex.normal, 0.0));
      joined.vertices.push_back(vertex);
    }
    for (const auto& triangle : mesh.triangles) {
      joined.triangles.push_back({triangle[0] + first, triangle[1] + first, triangle[2] + first});
    }
  }
  if (parts == Parts::kJoined) add(std::move(joined), glm::dmat4(1.0));
  return scene;
}

/// Where the wall is in the n-th frame: `metres` before a camera that goes around.
inline glm::dmat4 wallBefore(double metres, int frame) {
  const double t = 0.1 * frame;
  return glm::rotate(glm::translate(glm::dmat4(1.0), {0.01 * std::sin(t), 0.0, metres}),
                     3.14159265358979 + 0.15 * std::sin(0.7 * t), {1.0, 0.2 * std::cos(t), 0.05});
}

}  // namespace pleinair::support
