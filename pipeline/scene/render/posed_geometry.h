#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/clock.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/handle.h"
#include "pipeline/gpu/program.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/models/model_pose.h"
#include "pipeline/scene/render/drawn_model.h"

namespace pleinair::scene {

/// Where an object's data begin in the buffers of PosedGeometry, counted in their elements.
struct ObjectPlace {
  std::uint32_t firstTriangle = 0;  ///< of triangles()
  std::uint32_t firstNow = 0;       ///< of posed(): as the object is in this frame
  /// As it was in the frame before; nothing where it was not posed then.
  std::optional<std::uint32_t> firstThen;
};

/// A scene's models on the GPU: what never changes of them, and their vertices as they are posed in
/// this frame and the one before, which a compute pass writes once a frame for all who read them:
/// the raster pass and whatever lives on surfaces. All calls on the thread of the GL context it was
/// made in.
class PosedGeometry {
 public:
  /// Uploads the models. `library` has gpu::sceneShaders().
  PosedGeometry(const gpu::ShaderLibrary& library, const Scene& scene);

  /// Whether there is anything to draw.
  bool isEmpty() const { return triangleCount_ == 0; }

  /// Begins a frame: what was posed is that of the frame before.
  void beginFrame();
  /// Poses an object, as the scene counts its models from 0, `elapsed` after its clip's start and
  /// `turning` after the first frame. At most once a frame each; all before endPosing().
  void pose(std::size_t object, hal::Duration elapsed, hal::Duration turning);
  /// Runs the compute passes for all that was posed.
  void endPosing();
  /// Forgets the frame before.
  void reset();

  /// Around what an object was posed as, in its model's frame.
  const BoundingSphere& sphere(std::size_t object) const { return objects_[object].sphere; }
  /// Whether it looks the same at all times.
  bool isStill(std::size_t object) const;
  /// Closer around it, in parts.
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
  /// What was posed in this frame.
  ObjectPlace place(std::size_t object) const;

  /// 16 bytes a vertex: position (model's frame, metres, three floats), octahedral normal.
  const gpu::Buffer& posed() const { return posed_; }
  /// 16 bytes a triangle: DrawnTriangle; corners count from the object's first vertex.
  const gpu::Buffer& triangles() const { return triangles_; }

  /// Binds an object's posed vertices as attributes 0 (position) and 1 (octahedral normal) and what
  /// does not move as 2 (texture) and 3 (colour), with the indices; unbind() ends it. gl_VertexID
  /// of a triangle's last vertex is the triangle's number.
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
    std::uint32_t firstVertex = 0;  // of rest and looks
    std::uint32_t vertexCount = 0;
    std::uint32_t firstTriangle = 0;
    std::uint32_t firstIndex = 0;
    std::uint32_t firstDelta = 0;
  };
  struct ObjectSlot {
    std::size_t model = 0;
    std::uint32_t firstPosed = 0;  // from each half's start
    std::uint32_t firstMatrix = 0;
    std::uint32_t firstWeight = 0;
    ModelPose pose;
    BoundingSphere sphere;
    std::vector<BoundingSphere> spheres;
    bool isPosed = false;             // in this frame
    std::array<bool, 2> isWritten{};  // what each half holds of it is of its frame
    std::array<bool, 2> isAtRest{};   // what each half holds of a model that never moves
  };

  void addModel(const Model& model, std::vector<DrawnModel>& drawn);
  void upload(const std::vector<DrawnModel>& drawn);
  void makeVertexArray();
  void writeMatrices();
  void runPose(const ObjectSlot& object);

  const Scene& scene_;
  gpu::Program pose_;
  gpu::Program poseMorphed_;  // only where a model has morph targets
  std::vector<ModelSlot> models_;
  std::vector<ObjectSlot> objects_;
  std::uint32_t triangleCount_ = 0;
  std::uint32_t posedCount_ = 0;       // of a half
  std::uint32_t firstWeightRow_ = 0;   // of the matrices' rows
  std::size_t half_ = 0;               // of this frame
  std::vector<glm::vec4> matrixRows_;  // of all objects, then their weights
  gpu::Buffer rest_;
  gpu::Buffer looks_;
  gpu::Buffer indices_;
  gpu::Buffer triangles_;
  gpu::Buffer deltas_;
  gpu::Buffer matrices_;
  gpu::Buffer posed_;
  gpu::VertexArrayHandle vertexArray_;
};

}  // namespace pleinair::scene
