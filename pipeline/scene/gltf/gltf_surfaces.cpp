#include "pipeline/scene/gltf/gltf_surfaces.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "pipeline/scene/gltf/gltf_fault.h"
#include "pipeline/scene/gltf/gltf_limits.h"
#include "pipeline/scene/gltf/gltf_skins.h"

namespace pleinair::scene::gltf {
namespace {

/// Index of the accessor; -1 if the primitive has no such attribute.
int attributeOf(const tinygltf::Primitive& primitive, const std::string& name) {
  const auto found = primitive.attributes.find(name);
  return found == primitive.attributes.end() ? -1 : found->second;
}

glm::dvec3 areaOf(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const glm::dvec3 a(mesh.vertices[triangle[0]].position);
  const glm::dvec3 b(mesh.vertices[triangle[1]].position);
  const glm::dvec3 c(mesh.vertices[triangle[2]].position);
  return glm::cross(b - a, c - a);
}

/// Twice the triangle's area, along its normal. If the area is zero, that of the first morph target
/// that gives it one.
glm::dvec3 areaOnceMorphed(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  glm::dvec3 area = areaOf(mesh, triangle);
  for (const MorphTarget& target : mesh.morphTargets) {
    if (glm::length(area) > 0.0) break;
    const auto corner = [&](std::size_t i) {
      return glm::dvec3(mesh.vertices[triangle[i]].position) +
             glm::dvec3(target.positions[triangle[i]]);
    };
    area = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
  }
  return area;
}

/// Gives each triangle its own vertices and its own normal, as section 3.7.2.1 asks for files
/// without normals.
Mesh flatShaded(const Mesh& mesh) {
  Mesh flat;
  flat.vertices.reserve(3 * mesh.triangles.size());
  flat.morphTargets.resize(mesh.morphTargets.size());
  for (const auto& triangle : mesh.triangles) {
    const glm::vec3 normal(glm::normalize(areaOnceMorphed(mesh, triangle)));
    const auto first = static_cast<std::uint32_t>(flat.vertices.size());
    for (const std::uint32_t corner : triangle) {
      flat.vertices.push_back(mesh.vertices[corner]);
      flat.vertices.back().normal = normal;
      if (!mesh.joints.empty()) flat.joints.push_back(mesh.joints[corner]);
      if (!mesh.tangents.empty()) flat.tangents.push_back(mesh.tangents[corner]);
      for (std::size_t i = 0; i < mesh.morphTargets.size(); ++i) {
        flat.morphTargets[i].positions.push_back(mesh.morphTargets[i].positions[corner]);
      }
    }
    flat.triangles.push_back({first, first + 1, first + 2});
  }
  addFlatNormals(flat);
  return flat;
}

/// Exporters write normals of zero length where triangles without area meet. Such normals become
/// the mean of their triangles'.
void repairNormals(Mesh& mesh) {
  std::vector<glm::dvec3> sums(mesh.vertices.size(), glm::dvec3(0.0));
  for (const auto& triangle : mesh.triangles) {
    const glm::dvec3 area = areaOf(mesh, triangle);
    for (const std::uint32_t corner : triangle) sums[corner] += area;
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    glm::vec3& normal = mesh.vertices[i].normal;
    if (const float length = glm::length(normal); length > 1e-6F) {
      normal /= length;
      continue;
    }
    const double sum = glm::length(sums[i]);
    normal = sum > 0.0 ? glm::vec3(sums[i] / sum) : glm::vec3(0.0F, 1.0F, 0.0F);
  }
}

/// The corners of each triangle of an index list (section 3.7.2.1).
std::vector<std::array<std::uint32_t, 3>> trianglesOf(const std::vector<std::uint32_t>& indices,
                                                      int mode) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const std::size_t count = indices.size();
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    for (std::size_t i = 0; i + 2 < count; i += 3) {
      triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    }
    return triangles;
  }
  const bool isStrip = mode == TINYGLTF_MODE_TRIANGLE_STRIP;
  for (std::size_t i = 0; i + 2 < count; ++i) {
    if (isStrip) {
      triangles.push_back({indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
    } else {
      triangles.push_back({indices[i + 1], indices[i + 2], indices[0]});
    }
  }
  return triangles;
}

void checkCount(std::size_t found, std::size_t wanted, const std::string& where) {
  if (found != wanted) refuse(where, fmt::format("has {} elements, POSITION {}", found, wanted));
}

}  // namespace

std::optional<Mesh> SurfaceReader::read(const tinygltf::Primitive& primitive,
                                        const TextureMapping& mapping, bool isSkinned,
                                        const std::string& where) {
  if (primitive.mode >= TINYGLTF_MODE_POINTS && primitive.mode < TINYGLTF_MODE_TRIANGLES) {
    return std::nullopt;
  }
  if (primitive.mode < 0 && primitive.mode != -1) refuse(where + ".mode", "is none of glTF's");
  if (primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN) refuse(where + ".mode", "is none of glTF's");
  // Skipped as section 3.7.2.1 says.
  if (attributeOf(primitive, "POSITION") < 0) return std::nullopt;
  const bool isFlat = attributeOf(primitive, "NORMAL") < 0;
  Mesh mesh;
  readVertices(primitive, mapping, where, mesh);
  readTriangles(primitive, where, mesh);
  if (isSkinned) {
    VertexJoints held = readJointWeights(accessors_, primitive, mesh.vertices.size(), where);
    mesh.joints = std::move(held.joints);
    reducedVertices_ += held.reducedVertices;
  }
  mesh.morphTargets =
      morphs_.read(primitive, mesh.vertices.size(), isFlat ? 3 * mesh.triangles.size() : 0, where);
  std::erase_if(mesh.triangles, [&](const auto& triangle) {
    return !(glm::length(areaOnceMorphed(mesh, triangle)) > 0.0);
  });
  if (isFlat) return flatShaded(mesh);
  repairNormals(mesh);
  return mesh;
}

void SurfaceReader::readVertices(const tinygltf::Primitive& primitive,
                                 const TextureMapping& mapping, const std::string& where,
                                 Mesh& mesh) {
  const auto attribute = [&](const std::string& name) {
    const int accessor = attributeOf(primitive, name);
    return accessor < 0 ? std::vector<glm::vec4>()
                        : accessors_.vectors(accessor, where + ".attributes." + name);
  };
  const auto positions = attribute("POSITION");
  vertices_ += positions.size();
  if (vertices_ > kMaxVertices) {
    refuse(where, "makes too many vertices", fmt::format("at most {} in all", kMaxVertices));
  }
  mesh.vertices.resize(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    mesh.vertices[i].position = glm::vec3(positions[i]);
  }
  if (const auto normals = attribute("NORMAL"); !normals.empty()) {
    checkCount(normals.size(), positions.size(), where + ".attributes.NORMAL");
    for (std::size_t i = 0; i < normals.size(); ++i) {
      mesh.vertices[i].normal = glm::vec3(normals[i]);
    }
  }
  if (const auto tangents = attribute("TANGENT"); !tangents.empty()) {
    checkCount(tangents.size(), positions.size(), where + ".attributes.TANGENT");
    mesh.tangents.assign(tangents.begin(), tangents.end());
  }
  const std::string set = fmt::format("TEXCOORD_{}", mapping.set);
  if (const auto places = attribute(set); !places.empty()) {
    checkCount(places.size(), positions.size(), where + ".attributes." + set);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const glm::vec3 place(places[i].x, places[i].y, 1.0F);
      mesh.vertices[i].texture = glm::vec2(mapping.transform * place);
    }
  }
  if (const auto colours = attribute("COLOR_0"); !colours.empty()) {
    checkCount(colours.size(), positions.size(), where + ".attributes.COLOR_0");
    for (std::size_t i = 0; i < colours.size(); ++i) {
      mesh.vertices[i].colour = glm::clamp(colours[i], 0.0F, 1.0F);
    }
  }
}

void SurfaceReader::readTriangles(const tinygltf::Primitive& primitive, const std::string& where,
                                  Mesh& mesh) {
  std::vector<std::uint32_t> indices;
  if (primitive.indices >= 0) {
    for (const glm::uvec4& index : accessors_.integers(primitive.indices, where + ".indices")) {
      if (index.x >= mesh.vertices.size()) {
        refuse(fmt::format("{}.indices[{}]", where, indices.size()),
               fmt::format("found {}, of {} vertices", index.x, mesh.vertices.size()));
      }
      indices.push_back(index.x);
    }
  } else {
    for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) indices.push_back(i);
  }
  const int mode = primitive.mode == -1 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
  mesh.triangles = trianglesOf(indices, mode);
  triangles_ += mesh.triangles.size();
  if (triangles_ > kMaxSurfaceTriangles) {
    refuse(where, "makes too many triangles",
           fmt::format("at most {} in all", kMaxSurfaceTriangles));
  }
}

}  // namespace pleinair::scene::gltf
