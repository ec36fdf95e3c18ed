#include "pipeline/scene/meshes/mesh_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "pipeline/scene/gltf/gltf_fault.h"
#include "pipeline/scene/gltf/gltf_limits.h"
#include "pipeline/scene/gltf/gltf_resources.h"
#include "pipeline/scene/models/linear_light.h"

namespace pleinair::scene {
namespace {

namespace fs = std::filesystem;

constexpr float kCreaseDegrees = 35.0F;

bool endsInAnyCase(const fs::path& path, std::string_view ending) {
  std::string own = path.extension().string();
  std::ranges::transform(own, own.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return own == ending;
}

/// A file that was read into memory.
class ReadStream final : public Assimp::IOStream {
 public:
  explicit ReadStream(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {}

  size_t Read(void* to, size_t size, size_t count) override {
    if (size == 0) return 0;
    const std::size_t items = std::min(count, (bytes_.size() - position_) / size);
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(position_), items * size,
                static_cast<std::uint8_t*>(to));
    position_ += items * size;
    return items;
  }
  size_t Write(const void*, size_t, size_t) override { return 0; }
  aiReturn Seek(size_t offset, aiOrigin origin) override {
    std::size_t from = 0;
    if (origin == aiOrigin_CUR) from = position_;
    if (origin == aiOrigin_END) from = bytes_.size();
    if (offset > bytes_.size() - from) return aiReturn_FAILURE;
    position_ = from + offset;
    return aiReturn_SUCCESS;
  }
  size_t Tell() const override { return position_; }
  size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t position_ = 0;
};

/// Opens the files of one folder, for reading, within the limits.
class FolderFiles final : public Assimp::IOSystem {
 public:
  explicit FolderFiles(const fs::path& model)
      : folder_(fs::weakly_canonical(model.parent_path().empty() ? "." : model.parent_path(),
                                     ignored_)) {}

  bool Exists(const char* name) const override { return isInside(name); }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    if (mode == nullptr || *mode != 'r' || !isInside(name)) return nullptr;
    try {
      std::vector<std::uint8_t> bytes = gltf::readWholeFile(name, left_, name);
      left_ -= std::ssize(bytes);
      return new ReadStream(std::move(bytes));
    } catch (const gltf::Fault&) {
      return nullptr;  // a material file that is missing is told by assimp's result
    }
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  bool isInside(const fs::path& name) const {
    std::error_code failure;
    const fs::path file = fs::canonical(name, failure);  // links are followed
    if (failure || !fs::is_regular_file(file, failure)) return false;
    const fs::path within = file.lexically_relative(folder_);
    return !within.empty() && *within.begin() != "..";
  }

  std::error_code ignored_;
  fs::path folder_;
  std::int64_t left_ = gltf::kMaxResourceBytes;
};

glm::dmat4 matrixOf(const aiMatrix4x4& m) {
  return {m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2,
          m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4};
}

glm::vec3 checked(const aiVector3D& v) {
  const auto isSound = [](ai_real x) { return std::abs(x) <= gltf::kMaxCoordinate; };  // no NaN
  if (!isSound(v.x) || !isSound(v.y) || !isSound(v.z)) {
    gltf::refuse("", "has a coordinate that is no number, or too large",
                 fmt::format("at most {:g}", gltf::kMaxCoordinate));
  }
  return {v.x, v.y, v.z};
}

/// Converts assimp's scene to a Model.
class MeshModelBuilder {
 public:
  explicit MeshModelBuilder(const aiScene& scene) : scene_(scene) {}

  Model build() {
    for (unsigned i = 0; i < scene_.mNumMaterials; ++i) addMaterial(*scene_.mMaterials[i]);
    for (unsigned i = 0; i < scene_.mNumMeshes; ++i) addSurface(*scene_.mMeshes[i]);
    if (scene_.mRootNode != nullptr) addNode(*scene_.mRootNode, glm::dmat4(1.0), 0);
    if (model_.parts.empty()) gltf::refuse("", "has no triangle", "give a model with surfaces");
    numberParts(model_);
    if (hasTextures_) model_.notices.emplace_back("its textures are not shown; glTF keeps them");
    if (hasLines_) model_.notices.emplace_back("its points and lines are not shown");
    return std::move(model_);
  }

 private:
  void addMaterial(const aiMaterial& material) {
    aiColor3D colour(1.0F, 1.0F, 1.0F);
    material.Get(AI_MATKEY_COLOR_DIFFUSE, colour);
    hasTextures_ = hasTextures_ || material.GetTextureCount(aiTextureType_DIFFUSE) > 0;
    const auto channel = [](float value) {
      return std::isfinite(value) ? std::clamp(value, 0.0F, 1.0F) : 1.0F;
    };
    const glm::vec3 srgb(channel(colour.r), channel(colour.g), channel(colour.b));
    model_.materials.push_back(
        {.name = gltf::oneLine(std::string(material.GetName().C_Str())),
         .baseColour = glm::vec4(linearFromSrgb(srgb), 1.0F),
         // Meshes of CAD programs and scanners are often open, or turned inside out.
         .isDoubleSided = true});
  }

  void addSurface(const aiMesh& from) {
    Mesh mesh;
    vertices_ += from.mNumVertices;
    triangles_ += from.mNumFaces;
    if (vertices_ > gltf::kMaxVertices || triangles_ > gltf::kMaxSurfaceTriangles) {
      gltf::refuse("", fmt::format("has {} triangles or more", triangles_),
                   fmt::format("at most {}", gltf::kMaxSurfaceTriangles));
    }
    mesh.vertices.reserve(from.mNumVertices);
    for (unsigned i = 0; i < from.mNumVertices; ++i) {
      MeshVertex vertex{.position = checked(from.mVertices[i])};
      if (from.HasNormals()) vertex.normal = checked(from.mNormals[i]);
      const float length = glm::length(vertex.normal);
      vertex.normal = length > 0.0F ? vertex.normal / length : glm::vec3(0.0F, 0.0F, 1.0F);
      mesh.vertices.push_back(vertex);
    }
    for (unsigned i = 0; i < from.mNumFaces; ++i) {
      const aiFace& face = from.mFaces[i];
      if (face.mNumIndices != 3) {
        hasLines_ = true;
        continue;
      }
      const std::array<std::uint32_t, 3> corners{face.mIndices[0], face.mIndices[1],
                                                 face.mIndices[2]};
      if (std::ranges::all_of(corners, [&](auto corner) { return corner < from.mNumVertices; })) {
        mesh.triangles.push_back(corners);
      }
    }
    const std::size_t material =
        std::min<std::size_t>(from.mMaterialIndex, model_.materials.size() - 1);
    model_.surfaces.push_back({.mesh = std::move(mesh), .material = material});
  }

  void addNode(const aiNode& node, const glm::dmat4& parent, int depth) {
    constexpr int kMaxDepth = 64;
    if (depth > kMaxDepth) gltf::refuse("", "is nested too deeply");
    const glm::dmat4 place = parent * matrixOf(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const std::size_t surface = node.mMeshes[i];
      if (surface >= model_.surfaces.size() || model_.surfaces[surface].mesh.triangles.empty()) {
        continue;
      }
      std::string name = node.mName.length > 0 ? node.mName.C_Str()
                                               : fmt::format("part {}", model_.parts.size() + 1);
      model_.parts.push_back({.name = gltf::oneLine(std::move(name)),
                              .firstSurface = surface,
                              .surfaceCount = 1,
                              .modelFromPart = place});
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) addNode(*node.mChildren[i], place, depth + 1);
  }

  const aiScene& scene_;
  Model model_;
  std::size_t vertices_ = 0;
  std::size_t triangles_ = 0;
  bool hasTextures_ = false;
  bool hasLines_ = false;
};

Model importMesh(const fs::path& path) {
  // Opens it, so that what the system says of it is told, and not assimp's words.
  static_cast<void>(gltf::readWholeFile(path, gltf::kMaxFileBytes, ""));
  Assimp::Importer importer;
  importer.SetIOHandler(new FolderFiles(path));  // which it deletes
  importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, kCreaseDegrees);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  unsigned steps = aiProcess_Triangulate | aiProcess_GenSmoothNormals |
                   aiProcess_JoinIdenticalVertices | aiProcess_FindDegenerates;
  if (endsInAnyCase(path, ".stl")) {
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS);
    steps |= aiProcess_RemoveComponent;
  }
  const aiScene* const scene = importer.ReadFile(path.string(), steps);
  if (scene == nullptr) {
    gltf::refuse("", fmt::format("is a broken model: {}", importer.GetErrorString()),
                 "export it again, or convert it to glTF");
  }
  return MeshModelBuilder(*scene).build();
}

}  // namespace

bool isMeshFile(const fs::path& path) {
  return endsInAnyCase(path, ".stl") || endsInAnyCase(path, ".obj");
}

bool hasMaterials(const fs::path& path) {
  return !endsInAnyCase(path, ".stl");
}

hal::Result<Model> readMeshFile(const fs::path& path) {
  try {
    return importMesh(path);
  } catch (const gltf::Fault& fault) {
    return tl::unexpected(hal::Error{.kind = fault.kind(),
                                     .subject = path.string(),
                                     .problem = gltf::oneLine(fault.what()),
                                     .remedy = fault.remedy()});
  }
}

}  // namespace pleinair::scene
