#include "pipeline/scene/gltf/gltf_file.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/ext/matrix_transform.hpp>

#include "pipeline/scene/ar_frame.h"
#include "pipeline/scene/gltf/gltf_accessors.h"
#include "pipeline/scene/gltf/gltf_container.h"
#include "pipeline/scene/gltf/gltf_fault.h"
#include "pipeline/scene/gltf/gltf_limits.h"
#include "pipeline/scene/gltf/gltf_materials.h"
#include "pipeline/scene/gltf/gltf_nodes.h"
#include "pipeline/scene/gltf/gltf_resources.h"
#include "pipeline/scene/gltf/gltf_structure.h"
#include "pipeline/scene/gltf/gltf_surfaces.h"
#include "pipeline/scene/gltf/gltf_text.h"

namespace pleinair::scene {
namespace {

using gltf::refuse;

/// glTF: y up, z to the front. Ours: z up, −y to whoever reads the tag.
constexpr glm::dmat4 kModelFromGltf{1.0, 0.0,  0.0, 0.0, 0.0, 0.0, 1.0, 0.0,
                                    0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0};
constexpr double kWidestMetres = 1e6;

/// A comma-separated list that stays readable.
std::string shortList(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 8;
  const std::span<const std::string> first = std::span(names).first(std::min(kMost, names.size()));
  return fmt::format("{}{}", fmt::join(first, ", "), names.size() > kMost ? ", ..." : "");
}

class ModelBuilder {
 public:
  ModelBuilder(std::span<const std::uint8_t> file, std::optional<std::filesystem::path> folder)
      : container_(gltf::openContainer(file)),
        structure_(gltf::readStructure(container_.json)),
        resources_(structure_, container_.binary, std::move(folder)),
        accessors_(structure_, resources_),
        surfaces_(accessors_),
        materials_(structure_, resources_) {}

  Model build() {
    tree_ = gltf::nodeTreeOf(structure_.gltf);
    for (const std::size_t node : tree_.shown) addNode(node);
    numberParts(model_);
    const BoundingSphere sphere = boundingSphere(model_);
    if (!(sphere.radiusMetres + glm::length(sphere.centre) <= kWidestMetres)) {
      refuse("", fmt::format("is {:.3g} m wide or away", sphere.radiusMetres),
             fmt::format("at most {} m", kWidestMetres));
    }
    addNotices();
    return std::move(model_);
  }

 private:
  struct SurfaceRange {
    std::size_t first = 0;
    std::size_t count = 0;
    std::size_t triangles = 0;
  };

  void addNode(std::size_t index) {
    const tinygltf::Node& node = structure_.gltf.nodes[index];
    if (node.mesh == -1) return;
    const std::string where = fmt::format("nodes[{}]", index);
    const auto& meshes = structure_.gltf.meshes;
    if (node.mesh < 0 || static_cast<std::size_t>(node.mesh) >= meshes.size()) {
      refuse(where + ".mesh", fmt::format("there is no meshes[{}]", node.mesh));
    }
    const bool isSkinned = node.skin != -1;
    const SurfaceRange range = isSkinned
                                   ? addSurfaces(node.mesh, jointsOf(node.skin, where + ".skin"))
                                   : sharedSurfaces(node.mesh);
    if (range.triangles == 0) return;
    drawnTriangles_ += range.triangles;
    if (drawnTriangles_ > kMaxTriangles) {
      refuse(where, "makes too many triangles with its like",
             fmt::format("at most {} drawn", kMaxTriangles));
    }
    const std::string& meshName = meshes[static_cast<std::size_t>(node.mesh)].name;
    model_.parts.push_back(
        {.name = gltf::oneLine(!node.name.empty()  ? node.name
                               : !meshName.empty() ? meshName
                                                   : where),
         .firstSurface = range.first,
         .surfaceCount = range.count,
         // joints say where a skinned mesh is, not its node (section 3.7.3.3)
         .modelFromPart = isSkinned ? kModelFromGltf : kModelFromGltf * tree_.rootFromNode[index]});
  }

  SurfaceRange sharedSurfaces(int mesh) {
    const auto known = rangeOfMesh_.find(mesh);
    if (known != rangeOfMesh_.end()) return known->second;
    return rangeOfMesh_.emplace(mesh, addSurfaces(mesh, {})).first->second;
  }

  SurfaceRange addSurfaces(int meshIndex, const std::vector<glm::dmat4>& joints) {
    const auto& mesh = structure_.gltf.meshes[static_cast<std::size_t>(meshIndex)];
    primitives_ += mesh.primitives.size();
    if (primitives_ > gltf::kMaxPrimitives) {
      refuse(fmt::format("meshes[{}]", meshIndex), "makes too many primitives with its like",
             fmt::format("at most {} in all", gltf::kMaxPrimitives));
    }
    SurfaceRange range{.first = model_.surfaces.size()};
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
      const std::string where = fmt::format("meshes[{}].primitives[{}]", meshIndex, i);
      const tinygltf::Primitive& primitive = mesh.primitives[i];
      hasMorphs_ = hasMorphs_ || !primitive.targets.empty();
      const std::size_t material =
          materials_.place(primitive.material, model_, where + ".material");
      auto read = surfaces_.read(primitive, materials_.mapping(material), joints, where);
      if (!read) hasLines_ = true;
      if (!read || read->triangles.empty()) continue;
      range.triangles += read->triangles.size();
      model_.surfaces.push_back({.mesh = std::move(*read), .material = material});
    }
    range.count = model_.surfaces.size() - range.first;
    return range;
  }

  /// What takes a skin's mesh to where its joints are at rest.
  const std::vector<glm::dmat4>& jointsOf(int index, const std::string& where) {
    const auto known = jointsOfSkin_.find(index);
    if (known != jointsOfSkin_.end()) return known->second;
    return jointsOfSkin_.emplace(index, readJoints(index, where)).first->second;
  }

  std::vector<glm::dmat4> readJoints(int index, const std::string& where) {
    const auto& skins = structure_.gltf.skins;
    if (index < 0 || static_cast<std::size_t>(index) >= skins.size()) {
      refuse(where, fmt::format("there is no skins[{}]", index));
    }
    const tinygltf::Skin& skin = skins[static_cast<std::size_t>(index)];
    const std::string name = fmt::format("skins[{}]", index);
    if (skin.joints.empty()) refuse(name + ".joints", "is empty");
    if (skin.joints.size() > tree_.rootFromNode.size()) {  // each node once (section 5.28)
      refuse(name + ".joints",
             fmt::format("has {}, of {} nodes", skin.joints.size(), tree_.rootFromNode.size()));
    }
    std::vector<glm::dmat4> inverseBind(skin.joints.size(), glm::dmat4(1.0));
    if (skin.inverseBindMatrices != -1) {
      inverseBind = accessors_.matrices(skin.inverseBindMatrices, name + ".inverseBindMatrices");
      if (inverseBind.size() < skin.joints.size()) {
        refuse(name + ".inverseBindMatrices",
               fmt::format("has {} of {}", inverseBind.size(), skin.joints.size()));
      }
    }
    std::vector<glm::dmat4> joints;
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
      const int node = skin.joints[i];
      if (node < 0 || static_cast<std::size_t>(node) >= tree_.rootFromNode.size()) {
        refuse(fmt::format("{}.joints[{}]", name, i), fmt::format("there is no nodes[{}]", node));
      }
      joints.push_back(tree_.rootFromNode[static_cast<std::size_t>(node)] * inverseBind[i]);
    }
    return joints;
  }

  void addNotices() {
    auto& notices = model_.notices;
    if (!structure_.animations.empty()) {
      const std::size_t count = structure_.animations.size();
      notices.push_back(
          fmt::format("{} not played: {}",
                      count == 1 ? "its animation is" : fmt::format("its {} animations are", count),
                      shortList(structure_.animations)));
    }
    if (hasMorphs_) notices.emplace_back("its morph targets are not shown");
    if (hasLines_) notices.emplace_back("its points and lines are not shown");
    if (!materials_.blended().empty()) {
      notices.push_back("drawn solid or not at all instead of see-through: " +
                        shortList(materials_.blended()));
    }
    if (model_.parts.empty()) notices.emplace_back("there is nothing in it to be seen");
    for (std::string& notice : notices) notice = gltf::oneLine(std::move(notice));
  }

  gltf::Container container_;
  gltf::Structure structure_;
  gltf::Resources resources_;
  gltf::Accessors accessors_;
  gltf::SurfaceReader surfaces_;
  gltf::MaterialReader materials_;
  gltf::NodeTree tree_;
  Model model_;
  std::map<int, SurfaceRange> rangeOfMesh_;
  std::map<int, std::vector<glm::dmat4>> jointsOfSkin_;
  std::size_t primitives_ = 0;
  std::size_t drawnTriangles_ = 0;
  bool hasMorphs_ = false;
  bool hasLines_ = false;
};

/// What `make` gives, or the Fault that it threw.
template <class Function>
hal::Result<Model> withFaultsAsErrors(const std::string& name, Function make) {
  try {
    return make();
  } catch (const gltf::Fault& fault) {
    return tl::unexpected(hal::Error{.kind = fault.kind(),
                                     .subject = name,
                                     .problem = gltf::oneLine(fault.what()),
                                     .remedy = fault.remedy()});
  }
}

}  // namespace

hal::Result<Model> readGltf(const std::filesystem::path& path) {
  return withFaultsAsErrors(path.string(), [&] {
    const auto bytes = gltf::readWholeFile(path, gltf::kMaxFileBytes, "");
    return ModelBuilder(bytes, path.parent_path()).build();
  });
}

hal::Result<Model> parseGltf(std::span<const std::uint8_t> bytes, const std::string& name) {
  return withFaultsAsErrors(name, [&] { return ModelBuilder(bytes, std::nullopt).build(); });
}

}  // namespace pleinair::scene
