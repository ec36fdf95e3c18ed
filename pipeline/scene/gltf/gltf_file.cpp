#include "pipeline/scene/gltf/gltf_file.h"

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "pipeline/scene/gltf/gltf_accessors.h"
#include "pipeline/scene/gltf/gltf_animations.h"
#include "pipeline/scene/gltf/gltf_fault.h"
#include "pipeline/scene/gltf/gltf_limits.h"
#include "pipeline/scene/gltf/gltf_materials.h"
#include "pipeline/scene/gltf/gltf_morphs.h"
#include "pipeline/scene/gltf/gltf_nodes.h"
#include "pipeline/scene/gltf/gltf_resources.h"
#include "pipeline/scene/gltf/gltf_skins.h"
#include "pipeline/scene/gltf/gltf_structure.h"
#include "pipeline/scene/gltf/gltf_surfaces.h"
#include "pipeline/scene/models/limits.h"

namespace pleinair::scene {
namespace {

using gltf::refuse;

/// glTF: y up, z to the front. Ours: z up, −y towards the reader of the tag.
constexpr glm::dmat4 kModelFromGltf{1.0, 0.0,  0.0, 0.0, 0.0, 0.0, 1.0, 0.0,
                                    0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0};
constexpr double kMaxModelMetres = 1e6;

class ModelBuilder {
 public:
  ModelBuilder(std::span<const std::uint8_t> file, std::optional<std::filesystem::path> folder)
      : container_(gltf::openContainer(file)),
        structure_(gltf::readStructure(container_.json)),
        resources_(structure_, container_.binary, std::move(folder)),
        accessors_(structure_, resources_),
        surfaces_(accessors_),
        materials_(structure_, resources_),
        tree_(gltf::nodeTreeOf(structure_.gltf)),
        skins_(structure_, accessors_, tree_),
        clips_(structure_, resources_, tree_) {}

  Model build() {
    for (const std::size_t node : tree_.shown) addNode(node);
    addRig();
    numberParts(model_);
    const BoundingSphere sphere = boundingSphere(model_);
    if (!(sphere.radiusMetres + glm::length(sphere.centre) <= kMaxModelMetres)) {
      refuse("", fmt::format("is {:.3g} m wide or away", sphere.radiusMetres),
             fmt::format("at most {} m", kMaxModelMetres));
    }
    addNotices();
    return std::move(model_);
  }

 private:
  struct SurfaceRange {
    std::size_t first = 0;
    std::size_t count = 0;
    std::size_t triangles = 0;
    std::size_t vertices = 0;
    std::size_t morphs = 0;        ///< number of targets times number of vertices and triangles
    std::size_t highestJoint = 0;  ///< the highest one that holds any vertex
  };

  void addNode(std::size_t index) {
    const tinygltf::Node& node = structure_.gltf.nodes[index];
    if (node.mesh == -1) return;
    const std::string where = fmt::format("nodes[{}]", index);
    const auto& meshes = structure_.gltf.meshes;
    if (node.mesh < 0 || static_cast<std::size_t>(node.mesh) >= meshes.size()) {
      refuse(where + ".mesh", fmt::format("there is no meshes[{}]", node.mesh));
    }
    tree_.rig[tree_.rigIndex[index]].weights = gltf::restWeightsOf(structure_.gltf, index);
    const bool isSkinned = node.skin != -1;
    const SurfaceRange range = surfacesOf(node.mesh, isSkinned);
    std::optional<std::size_t> skin;
    if (isSkinned) skin = skinOf(node, range, where);
    if (range.triangles == 0) return;
    drawnTriangles_ += range.triangles;
    if (drawnTriangles_ > kMaxTriangles) {
      refuse(where, "exceeds the total number of triangles",
             fmt::format("at most {} drawn", kMaxTriangles));
    }
    drawnVertices_ += range.vertices;
    if (drawnVertices_ > gltf::kMaxDrawnVertices) {
      refuse(where, "exceeds the total number of shown vertices",
             fmt::format("at most {} in all", gltf::kMaxDrawnVertices));
    }
    drawnMorphs_ += range.morphs;
    if (drawnMorphs_ > gltf::kMaxDrawnMorphs) {
      refuse(where, "exceeds the total number of morphed vertices",
             fmt::format("at most {} in all, counted for each target", gltf::kMaxDrawnMorphs));
    }
    const std::string& meshName = meshes[static_cast<std::size_t>(node.mesh)].name;
    model_.parts.push_back(
        {.name = gltf::oneLine(!node.name.empty()  ? node.name
                               : !meshName.empty() ? meshName
                                                   : where),
         .firstSurface = range.first,
         .surfaceCount = range.count,
         // joints say where a skinned mesh is, not its node (section 3.7.3.3)
         .modelFromPart = isSkinned ? kModelFromGltf : kModelFromGltf * tree_.rootFromNode[index],
         .node = tree_.rigIndex[index],
         .skin = skin});
  }

  /// Index of the skin in the rig, after checking that it fits the surfaces.
  std::size_t skinOf(const tinygltf::Node& node, const SurfaceRange& range,
                     const std::string& where) {
    const std::size_t place = skins_.place(node.skin, model_.rig.skins, where + ".skin");
    const std::size_t joints = model_.rig.skins[place].joints.size();
    if (range.highestJoint >= joints) {
      refuse(where + ".skin", fmt::format("meshes[{}] is held by joint {}, of {} of skins[{}]",
                                          node.mesh, range.highestJoint, joints, node.skin));
    }
    posedJoints_ += joints;
    if (posedJoints_ > gltf::kMaxPosedJoints) {
      refuse(where + ".skin", "exceeds the total number of posed joints",
             fmt::format("at most {}", gltf::kMaxPosedJoints));
    }
    return place;
  }

  /// Surfaces of a mesh. Nodes that show the same mesh share them.
  const SurfaceRange& surfacesOf(int mesh, bool isSkinned) {
    const std::pair key(mesh, isSkinned);
    const auto known = ranges_.find(key);
    if (known != ranges_.end()) return known->second;
    return ranges_.emplace(key, addSurfaces(mesh, isSkinned)).first->second;
  }

  SurfaceRange addSurfaces(int meshIndex, bool isSkinned) {
    const auto& mesh = structure_.gltf.meshes[static_cast<std::size_t>(meshIndex)];
    primitives_ += mesh.primitives.size();
    if (primitives_ > gltf::kMaxPrimitives) {
      refuse(fmt::format("meshes[{}]", meshIndex), "exceeds the total number of primitives",
             fmt::format("at most {} in all", gltf::kMaxPrimitives));
    }
    gltf::checkMorphTargets(mesh, fmt::format("meshes[{}]", meshIndex));
    SurfaceRange range{.first = model_.surfaces.size()};
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
      const std::string where = fmt::format("meshes[{}].primitives[{}]", meshIndex, i);
      const tinygltf::Primitive& primitive = mesh.primitives[i];
      const std::size_t material =
          materials_.place(primitive.material, model_, where + ".material");
      auto read = surfaces_.read(primitive, materials_.mapping(material), isSkinned, where);
      if (!read) hasLines_ = true;
      if (!read || read->triangles.empty()) continue;
      range.triangles += read->triangles.size();
      range.vertices += read->vertices.size();
      range.highestJoint = std::max(range.highestJoint, gltf::highestJoint(*read));
      range.morphs += read->morphTargets.size() * (read->vertices.size() + read->triangles.size());
      model_.surfaces.push_back({.mesh = std::move(*read), .material = material});
    }
    range.count = model_.surfaces.size() - range.first;
    return range;
  }

  /// Adds a rig if anything needs one; all other nodes have fixed positions.
  void addRig() {
    model_.rig.clips = clips_.read();
    if (model_.rig.clips.empty() && model_.rig.skins.empty() && drawnMorphs_ == 0) {
      for (ModelPart& part : model_.parts) part.node.reset();
      return;
    }
    model_.rig.nodes = std::move(tree_.rig);
    model_.rig.modelFromRoot = kModelFromGltf;
  }

  void addNotices() {
    auto& notices = model_.notices;
    notices = clips_.notices();
    if (surfaces_.reducedVertices() > 0) {
      notices.push_back(
          fmt::format("{} of its vertices are held by more than 4 joints; the strongest 4 do",
                      surfaces_.reducedVertices()));
    }
    if (surfaces_.hasOtherMorphs()) {
      notices.emplace_back("its morph targets move vertices, but no colours and no textures");
    }
    if (hasLines_) notices.emplace_back("its points and lines are not shown");
    if (!materials_.blended().empty()) {
      notices.push_back("drawn opaque or alpha-masked instead of blended: " +
                        gltf::shortList(materials_.blended()));
    }
    if (model_.parts.empty()) notices.emplace_back("it contains nothing visible");
    for (std::string& notice : notices) notice = gltf::oneLine(std::move(notice));
  }

  gltf::Container container_;
  gltf::Structure structure_;
  gltf::Resources resources_;
  gltf::Accessors accessors_;
  gltf::SurfaceReader surfaces_;
  gltf::MaterialReader materials_;
  gltf::NodeTree tree_;
  gltf::SkinReader skins_;
  gltf::ClipReader clips_;
  Model model_;
  std::map<std::pair<int, bool>, SurfaceRange> ranges_;  ///< per mesh, and whether with a skin
  std::size_t primitives_ = 0;
  std::size_t posedJoints_ = 0;
  std::size_t drawnTriangles_ = 0;
  std::size_t drawnVertices_ = 0;
  std::size_t drawnMorphs_ = 0;
  bool hasLines_ = false;
};

/// The result of `make`, or the Fault that it threw as an error.
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
