#include "pipeline/scene/builtin/builtin_moving.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "pipeline/scene/builtin/shapes.h"

namespace pleinair::scene {
namespace {

constexpr std::uint32_t kAround = 64;

/// Two colours in linear light, in spirals with soft borders.
glm::vec4 bandColour(double around, double along) {
  constexpr glm::dvec3 kOchre{0.62, 0.27, 0.05};
  constexpr glm::dvec3 kBlue{0.04, 0.14, 0.33};
  const double wave = std::sin(3.0 * around + 14.0 * along);
  return glm::vec4(glm::mix(kBlue, kOchre, glm::smoothstep(-0.35, 0.35, wave)), 1.0F);
}

/// A closed surface over rows of kAround + 1 vertices, the last of which repeats the first; the
/// first and the last row are points. `vertexAt`: around in [0, 2π), row in [0, 1] from the bottom.
Mesh rolled(std::uint32_t rows, const std::function<MeshVertex(double, double)>& vertexAt) {
  Mesh mesh;
  for (std::uint32_t row = 0; row <= rows; ++row) {
    for (std::uint32_t i = 0; i <= kAround; ++i) {
      mesh.vertices.push_back(
          vertexAt(kTurn * (i % kAround) / kAround, static_cast<double>(row) / rows));
    }
  }
  const auto at = [](std::uint32_t row, std::uint32_t i) { return row * (kAround + 1) + i; };
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t i = 0; i < kAround; ++i) {
      if (row > 0) mesh.triangles.push_back({at(row, i), at(row, i + 1), at(row + 1, i + 1)});
      if (row + 1 < rows) {
        mesh.triangles.push_back({at(row, i), at(row + 1, i + 1), at(row + 1, i)});
      }
    }
  }
  return mesh;
}

/// The normals of a surface that rolled() made, from its triangles, those of equal places together.
std::vector<glm::vec3> normalsOf(const Mesh& mesh, const std::vector<glm::dvec3>& places) {
  std::vector<glm::dvec3> sums(places.size(), glm::dvec3(0.0));
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec3 normal = glm::cross(places[b] - places[a], places[c] - places[a]);
    for (const std::uint32_t corner : {a, b, c}) sums[corner] += normal;
  }
  const std::size_t rows = places.size() / (kAround + 1);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t first = row * (kAround + 1);
    const bool isPole = row == 0 || row + 1 == rows;
    glm::dvec3 together = sums[first] + sums[first + kAround];
    if (isPole) {
      for (std::size_t i = 1; i < kAround; ++i) together += sums[first + i];
    }
    sums[first] = sums[first + kAround] = together;
    for (std::size_t i = 1; isPole && i < kAround; ++i) sums[first + i] = together;
  }
  std::vector<glm::vec3> normals;
  normals.reserve(sums.size());
  for (const glm::dvec3& sum : sums) normals.emplace_back(glm::normalize(sum));
  return normals;
}

Model deformedModel(std::string name, Mesh mesh) {
  Model model;
  model.surfaces.push_back({.mesh = std::move(mesh)});
  model.materials.push_back({.name = name});
  model.parts.push_back({.name = std::move(name), .surfaceCount = 1});
  return model;
}

}  // namespace

Model tubeModel(const TubeParameters& parameters) {
  constexpr std::size_t kJoints = 7;
  constexpr double kSwayRad = 0.16;  // of each joint against the one below
  constexpr double kSeconds = 2.0;
  constexpr int kKeys = 24;
  const double length = parameters.lengthMetres;
  const double radius = 0.15 * length;
  const double straight = length - radius;  // a half ball on top
  // A closed bottom, the side, and the half ball: rows by the way along the profile.
  const double way = radius + straight + 0.25 * kTurn * radius;
  Mesh mesh = rolled(72, [&](double around, double row) {
    const glm::dvec2 out(std::cos(around), std::sin(around));
    const double along = row * way;
    double away = radius;
    double z = 0.0;
    if (along < radius) {
      away = along;
    } else if (along < radius + straight) {
      z = along - radius;
    } else {
      const double angle = std::min((along - radius - straight) / radius, 0.25 * kTurn);
      away = row < 1.0 ? radius * std::cos(angle) : 0.0;
      z = straight + radius * std::sin(angle);
    }
    return MeshVertex{.position = glm::vec3(away * out.x, away * out.y, z),
                      .colour = bandColour(around, z / length)};
  });
  std::vector<glm::dvec3> places;
  for (const MeshVertex& vertex : mesh.vertices) places.emplace_back(vertex.position);
  const std::vector<glm::vec3> normals = normalsOf(mesh, places);
  const double step = length / kJoints;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    mesh.vertices[i].normal = normals[i];
    const double at = std::clamp(places[i].z / step - 0.5, 0.0, kJoints - 1.0);
    const auto low = static_cast<std::uint16_t>(std::min(at, kJoints - 2.0));
    const auto part = static_cast<float>(at - low);
    mesh.joints.push_back({.joints = {low, static_cast<std::uint16_t>(low + 1), 0, 0},
                           .weights = {1.0F - part, part, 0.0F, 0.0F}});
  }

  Model model = deformedModel("tube", std::move(mesh));
  Skin skin;
  Clip clip{.name = "sway", .seconds = kSeconds};
  for (std::size_t joint = 0; joint < kJoints; ++joint) {
    const double z = step * static_cast<double>(joint);
    RigNode node;
    if (joint > 0) node.parent = joint - 1;
    node.rest.translation = {0.0, 0.0, joint > 0 ? step : 0.0};
    model.rig.nodes.push_back(node);
    skin.joints.push_back(joint);
    skin.jointFromMesh.push_back(glm::translate(glm::dmat4(1.0), {0.0, 0.0, -z}));
    if (joint == 0) continue;  // stands
    Channel channel{.node = joint, .property = AnimatedProperty::kRotation, .width = 4};
    for (int key = 0; key <= kKeys; ++key) {
      const double turn = kTurn * key / kKeys - 0.35 * static_cast<double>(joint);
      const double sideways = 0.5 * kSwayRad * std::sin(turn);
      const double forwards = 0.25 * kSwayRad * std::cos(turn);
      const glm::dquat rotation =
          glm::normalize(glm::dquat(1.0, std::tan(forwards), std::tan(sideways), 0.0));
      channel.seconds.push_back(static_cast<float>(kSeconds * key / kKeys));
      for (const double value : {rotation.x, rotation.y, rotation.z, rotation.w}) {
        channel.values.push_back(static_cast<float>(value));
      }
    }
    clip.channels.push_back(std::move(channel));
  }
  model.rig.skins.push_back(std::move(skin));
  model.rig.clips.push_back(std::move(clip));
  model.parts.front().skin = 0;
  numberParts(model);
  return model;
}

Model ballModel(const BallParameters& parameters) {
  constexpr std::uint32_t kRows = 48;
  constexpr double kSeconds = 2.4;
  constexpr int kKeys = 24;
  const double radius = 0.5 * parameters.diameterMetres;
  const glm::dvec3 centre(0.0, 0.0, radius);
  Mesh mesh = rolled(kRows, [&](double around, double row) {
    const double up = 0.5 * kTurn * (row - 0.5);
    const double flat = row > 0.0 && row < 1.0 ? std::cos(up) : 0.0;
    const glm::dvec3 out(flat * std::cos(around), flat * std::sin(around), std::sin(up));
    return MeshVertex{.position = glm::vec3(centre + radius * out),
                      .normal = glm::vec3(out),
                      .colour = bandColour(around, row)};
  });
  // Both keep the lowest point on the ground.
  const auto lobes = [](const glm::dvec3& out) {
    const double around = std::atan2(out.y, out.x);
    const double flat = 1.0 - out.z * out.z;
    return (1.0 + 0.3 * flat * flat * std::cos(3.0 * around)) * out;
  };
  const auto squeezed = [](const glm::dvec3& out) {
    return glm::dvec3(1.25 * out.x, 1.25 * out.y, 0.62 * (out.z + 1.0) - 1.0);
  };
  for (const std::function<glm::dvec3(const glm::dvec3&)>& shape :
       {std::function<glm::dvec3(const glm::dvec3&)>(lobes), {squeezed}}) {
    std::vector<glm::dvec3> places;
    for (const MeshVertex& vertex : mesh.vertices) {
      places.push_back(centre + radius * shape((glm::dvec3(vertex.position) - centre) / radius));
    }
    const std::vector<glm::vec3> normals = normalsOf(mesh, places);
    MorphTarget target;
    for (std::size_t i = 0; i < places.size(); ++i) {
      target.positions.push_back(glm::vec3(places[i]) - mesh.vertices[i].position);
      target.normals.push_back(normals[i] - mesh.vertices[i].normal);
    }
    mesh.morphTargets.push_back(std::move(target));
  }

  Model model = deformedModel("ball", std::move(mesh));
  RigNode node;
  node.weights = {0.0F, 0.0F};
  model.rig.nodes.push_back(node);
  Channel channel{.node = 0, .property = AnimatedProperty::kWeights, .width = 2};
  for (int key = 0; key <= kKeys; ++key) {
    const double turn = kTurn * key / kKeys;
    channel.seconds.push_back(static_cast<float>(kSeconds * key / kKeys));
    channel.values.push_back(static_cast<float>(std::sin(turn)));
    channel.values.push_back(static_cast<float>(0.5 - 0.5 * std::cos(2.0 * turn)));
  }
  model.rig.clips.push_back({.name = "change", .seconds = kSeconds, .channels = {channel}});
  model.parts.front().node = 0;
  numberParts(model);
  return model;
}

}  // namespace pleinair::scene
