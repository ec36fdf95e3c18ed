#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/clock.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/handle.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/models/model_pose.h"
#include "pipeline/scene/render/drawn_model.h"

namespace pleinair::scene {

/// Offsets of an object's data in the buffers of PosedGeometry, in elements.
struct ObjectPlace {
  std::uint32_t firstTriangle = 0;  ///< in triangles()
  std::uint32_t firstCurrent = 0;   ///< in posed(): the object in this frame
  /// In posed(): the object in the previous frame; nothing if it was not posed then.
  std::optional<std::uint32_t> firstPrevious;
};

/// A scene's models on the GPU: their constant data, and their posed vertices in this frame and the
/// previous one. A compute pass writes the vertices once per frame for all readers: the raster pass
/// and the marks on surfaces. All calls on the thread of the GL context that it was made in.
class PosedGeometry {
 public:
  /// Uploads the models. `library` has gpu::sceneShaders().
  PosedGeometry(const gpu::ShaderLibrary& library, const Scene& scene);

  /// Whether there is nothing to draw.
  bool isEmpty() const { return triangleCount_ == 0; }

  /// Begins a frame: the posed vertices become those of the previous frame.
  void beginFrame();
  /// Poses an object (index of the model in the scene) at `elapsed` after its clip's start and
  /// `turning` after the first frame. At most once per frame each; all before endPosing().
  void pose(std::size_t object, hal::Duration elapsed, hal::Duration turning);
  /// From the next pose() on, parts whose byte is not 0 are not there: they are drawn nowhere, cast
  /// no shadow and hide nothing. One byte a part of the object's model; none: all are there.
  void hideParts(std::size_t object, std::span<const std::uint8_t> hidden);
  /// Runs the compute passes for all posed objects.
  void endPosing();
  /// Forgets the previous frame.
  void reset();

  /// A sphere around the posed object, in its model's frame.
  const BoundingSphere& sphere(std::size_t object) const { return objects_[object].sphere; }
  /// Whether the object never changes, and looks as it did in the frame before: false in the first
  /// two frames, and after hideParts().
  bool isStatic(std::size_t object) const;
  /// Several spheres that bound it more closely.
  std::span<const BoundingSphere> spheres(std::size_t object) const {
    return objects_[object].spheres;
  }
  const Model& model(std::size_t object) const { return *models_[objects_[object].model].model; }
  const std::vector<gpu::Texture>& textures(std::size_t object) const {
    return models_[objects_[object].model].textures;
  }
  const std::vector<DrawBatch>& batches(std::size_t object) const {
    return models_[objects_[object].model].batches;
  }
  /// Number of an object's vertices in posed().
  std::size_t vertexCount(std::size_t object) const {
    return models_[objects_[object].model].vertexCount;
  }
  /// Offsets of an object posed in this frame.
  ObjectPlace place(std::size_t object) const;

  /// 16 bytes per vertex: position (model's frame, metres, three floats), octahedral normal.
  const gpu::Buffer& posed() const { return posed_; }
  /// 16 bytes per triangle: DrawnTriangle; corners count from the object's first vertex.
  const gpu::Buffer& triangles() const { return triangles_; }
  /// 4 bytes per triangle: DrawnForm.
  const gpu::Buffer& forms() const { return forms_; }

  /// Binds an object's posed vertices as attributes 0 (position) and 1 (octahedral normal), its
  /// constant data as 2 (texture) and 3 (colour), and its indices; unbind() ends it. gl_VertexID of
  /// a triangle's last vertex is the triangle's number.
  void bind(std::size_t object) const;
  static void unbind();
  /// Draws triangles of the bound object.
  void draw(std::size_t object, const DrawBatch& batch) const;

 private:
  struct ModelSlot {
    const Model* model = nullptr;
    std::vector<gpu::Texture> textures;
    std::vector<DrawBatch> batches;
    std::vector<PoseRange> ranges;
    std::uint32_t firstVertex = 0;  // in rest and looks
    std::uint32_t vertexCount = 0;
    std::uint32_t firstTriangle = 0;
    std::uint32_t firstIndex = 0;
    std::uint32_t firstDelta = 0;
  };
  struct ObjectSlot {
    std::size_t model = 0;
    std::uint32_t firstPosed = 0;  // from the start of each half
    std::uint32_t firstMatrix = 0;
    std::uint32_t firstWeight = 0;
    ModelPose pose;
    BoundingSphere sphere;
    std::vector<BoundingSphere> spheres;
    std::vector<std::uint8_t> hidden;  // per part; empty: none
    bool isPosed = false;              // in this frame
    std::array<bool, 2> isWritten{};   // whether each half holds the pose of its frame
    std::array<bool, 2> isAtRest{};    // whether each half holds a static model's pose
  };

  void addModel(const Model& model, std::vector<DrawnModel>& drawn);
  void upload(const std::vector<DrawnModel>& drawn);
  void makeVertexArray();
  void writeMatrices();
  void runPose(const ObjectSlot& object);

  const Scene& scene_;
  gpu::Program pose_;
  gpu::Program poseMorphed_;  // only if a model has morph targets
  std::vector<ModelSlot> models_;
  std::vector<ObjectSlot> objects_;
  std::uint32_t triangleCount_ = 0;
  std::uint32_t posedCount_ = 0;       // per half
  std::uint32_t firstWeightRow_ = 0;   // row of the first weight, after the matrices
  std::size_t half_ = 0;               // of this frame
  std::vector<glm::vec4> matrixRows_;  // of all objects, followed by their weights
  gpu::Buffer rest_;
  gpu::Buffer attributes_;
  gpu::Buffer indices_;
  gpu::Buffer triangles_;
  gpu::Buffer forms_;
  gpu::Buffer deltas_;
  gpu::Buffer matrices_;
  gpu::Buffer posed_;
  gpu::VertexArrayHandle vertexArray_;
};

}  // namespace pleinair::scene
