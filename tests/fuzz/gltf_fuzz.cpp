// Parses bytes as a glTF model (container, JSON, nodes, accessors, textures, skins, morph targets)
// and poses the model at several times of its clips. Touches no file. The input is a .glb or a
// .gltf. Text is also wrapped into a .glb, so that a mutation need not keep chunk lengths right:
// JSON up to the first NUL, BIN after it.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/geometric.hpp>

#include "pipeline/scene/gltf/gltf_file.h"
#include "pipeline/scene/models/model.h"
#include "pipeline/scene/models/model_pose.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

using namespace pleinair;

void require(bool holds, const char* what) {
  if (!holds) fuzz::fail(what);
}

void requireSound(const scene::MeshVertex& vertex) {
  for (int i = 0; i < 3; ++i) {
    require(std::isfinite(vertex.position[i]), "a position that is none");
  }
  require(std::abs(glm::length(vertex.normal) - 1.0F) < 1e-3F, "a normal that is none");
  require(std::isfinite(vertex.texture.x) && std::isfinite(vertex.texture.y),
          "a place that is none");
}

void requireSound(const scene::Surface& surface, const scene::Model& model) {
  require(surface.material < model.materials.size(), "no such material");
  for (const auto& triangle : surface.mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      require(corner < surface.mesh.vertices.size(), "no such vertex");
    }
  }
  for (const scene::MeshVertex& vertex : surface.mesh.vertices) requireSound(vertex);
  const std::size_t count = surface.mesh.vertices.size();
  require(surface.mesh.joints.empty() || surface.mesh.joints.size() == count, "joints of others");
  for (const scene::JointWeights& held : surface.mesh.joints) {
    const float sum = held.weights[0] + held.weights[1] + held.weights[2] + held.weights[3];
    require(std::abs(sum - 1.0F) < 1e-3F, "weights that do not sum to 1");
  }
  for (const scene::MorphTarget& target : surface.mesh.morphTargets) {
    require(target.positions.size() == count, "a target of others");
    require(target.normals.empty() || target.normals.size() == count, "normals of others");
  }
}

void requireSound(const scene::Model& model) {
  for (const scene::Surface& surface : model.surfaces) requireSound(surface, model);
  for (const scene::Material& material : model.materials) {
    require(!material.texture || *material.texture < model.textures.size(), "no such texture");
  }
  for (const scene::ModelPart& part : model.parts) {
    require(part.firstSurface + part.surfaceCount <= model.surfaces.size(), "no such surface");
    if (part.triangleCount > 0) {
      require(partOfTriangle(model, part.firstTriangle) == &part,
              "a first triangle of another part");
      require(partOfTriangle(model, part.firstTriangle + part.triangleCount - 1) == &part,
              "a last triangle of another part");
    }
  }
  require(partOfTriangle(model, model.triangleCount()) == nullptr, "a triangle too many");
  require(std::isfinite(boundingSphere(model).radiusMetres), "no bounds");
}

/// Checks that a few vertices of each surface are where the pose puts them, and within its sphere.
void requireSound(const scene::Model& model, const scene::ModelPose& pose) {
  const scene::BoundingSphere sphere = scene::boundingSphere(model, pose);
  require(std::isfinite(sphere.radiusMetres), "no bounds of a pose");
  // positions are rounded to floats
  const double reach =
      sphere.radiusMetres + 1e-5 * (sphere.radiusMetres + glm::length(sphere.centre));
  std::size_t left = 10'000;
  for (const scene::ModelPart& part : model.parts) {
    for (std::size_t i = 0; i < part.surfaceCount; ++i) {
      const std::size_t count = model.surfaces[part.firstSurface + i].mesh.vertices.size();
      for (std::size_t v = 0; v < count && left > 0; v += 1 + count / 64, --left) {
        const scene::MeshVertex vertex = scene::posedVertex(model, part, i, v, pose);
        requireSound(vertex);
        require(glm::distance(glm::dvec3(vertex.position), sphere.centre) <= reach,
                "a vertex out of bounds");
      }
    }
  }
}

void requireSoundPoses(const scene::Model& model) {
  scene::ModelPose pose;
  scene::poseModel(model, std::nullopt, hal::Duration::zero(), pose);
  requireSound(model, pose);
  for (std::size_t clip = 0; clip < std::min<std::size_t>(model.rig.clips.size(), 4); ++clip) {
    require(!model.rig.clips[clip].name.empty(), "a clip without a name");
    for (const double share : {0.0, 0.37, 0.5, 1.0}) {
      const scene::ClipMoment moment{clip, share * model.rig.clips[clip].seconds};
      scene::poseModel(model, moment, hal::Duration::zero(), pose);
      requireSound(model, pose);
    }
  }
}

void load(std::span<const std::uint8_t> bytes) {
  const hal::Result<scene::Model> model = scene::parseGltf(bytes, "fuzz.glb");
  if (model) {
    requireSound(*model);
    requireSoundPoses(*model);
  } else {
    fuzz::expectOneLine(model.error().message());
  }
}

void append(std::vector<std::uint8_t>& to, std::uint32_t word) {
  for (int i = 0; i < 4; ++i) to.push_back(static_cast<std::uint8_t>(word >> (8 * i)));
}

void appendChunk(std::vector<std::uint8_t>& to, std::uint32_t type,
                 std::span<const std::uint8_t> bytes, std::uint8_t padding) {
  const std::size_t padded = (bytes.size() + 3) / 4 * 4;
  append(to, static_cast<std::uint32_t>(padded));
  append(to, type);
  to.insert(to.end(), bytes.begin(), bytes.end());
  to.insert(to.end(), padded - bytes.size(), padding);
}

std::vector<std::uint8_t> asBinary(std::span<const std::uint8_t> bytes) {
  const auto nul = static_cast<std::size_t>(std::ranges::find(bytes, 0) - bytes.begin());
  std::vector<std::uint8_t> chunks;
  appendChunk(chunks, 0x4E4F534A, bytes.first(nul), ' ');
  if (nul + 1 < bytes.size()) appendChunk(chunks, 0x004E4942, bytes.subspan(nul + 1), 0);
  std::vector<std::uint8_t> file;
  append(file, 0x46546C67);
  append(file, 2);
  append(file, static_cast<std::uint32_t>(12 + chunks.size()));
  file.insert(file.end(), chunks.begin(), chunks.end());
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span bytes(data, size);
  load(bytes);
  if (size > 0 && data[0] == '{') load(asBinary(bytes));
  return 0;
}
