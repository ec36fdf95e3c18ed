#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/handle.h"
#include "pipeline/gpu/pass_timer.h"
#include "pipeline/gpu/program.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/ar_frame.h"
#include "pipeline/scene/pose_set.h"
#include "pipeline/scene/scene.h"
#include "pipeline/scene/scene_shaders.h"

namespace pleinair::scene {

/// Composes AR frames: a scene's models, toon-shaded (thesis §3.2.2), over the camera's picture.
/// Parts that turn do so by the frames' capture times, counted from the first frame. Silhouettes
/// are not anti-aliased: each pixel has one object. All calls on the thread of the GL context it
/// was made in.
class ArFrameRenderer {
 public:
  /// Uploads the scene's models. `library` has gpu::gpuShaders() and gpu::sceneShaders().
  /// ArFrame::ids counts models in the scene's order and triangles as their parts do.
  ArFrameRenderer(const gpu::ShaderLibrary& library, Scene scene);

  /// Allocates for pictures of `size` and runs each program once, so that the first frame does not
  /// wait for drivers (GPU.md, rule 14).
  void warmUp(hal::FrameSize size);

  /// The next AR frame, valid until the next call and as long as `picture`, which it refers to
  /// where no model is seen. A model is drawn where the pose is known of what it is attached to; a
  /// tag that is hidden is where the world has it. Each size is allocated for once.
  /// Precondition: picture (RGBA8, LINEAR) has camera.imageSize() (see fittedCamera()).
  const ArFrame& compose(const gpu::Texture& picture, const tracking::CameraModel& camera,
                         const PoseSet& poses, std::uint64_t sequence, hal::TimePoint captureTime,
                         gpu::PassTimer& timer);

 private:
  /// A surface's place in the vertex buffer.
  struct SurfaceSlot {
    GLint firstVertex = 0;
    GLsizei vertexCount = 0;
  };
  /// What the GPU has of a model.
  struct ModelSlot {
    const Model* model = nullptr;
    std::vector<SurfaceSlot> surfaces;
    std::vector<gpu::Texture> textures;
    BoundingSphere sphere;
  };
  /// What frames of one size are drawn into.
  struct Surfaces {
    Surfaces(hal::FrameSize size, bool hasModels);

    gpu::Texture ids;
    gpu::Texture normalFocus;
    gpu::Texture depth;
    gpu::Texture colour;              // where there are models
    gpu::RenderTarget target;         // all of them
    gpu::RenderTarget withoutColour;  // for frames that show the camera's picture only
    bool showsCameraOnly = false;     // what ids, normals and depth hold
  };
  /// A model in this frame.
  struct Visible {
    std::size_t model = 0;
    glm::dmat4 cameraFromAttach{1.0};
    glm::dmat4 cameraFromModel{1.0};
  };
  void uploadModels();
  void uploadVertices();
  void takeSurfaces(hal::FrameSize size);
  void findVisible(const PoseSet& poses);
  void clearToCamera();
  void drawBackground(const gpu::Texture& picture);
  void setCamera(const tracking::CameraModel& camera);
  void drawModels(hal::Duration time);
  void drawModel(const Visible& visible, hal::Duration time);
  void drawPart(const ModelSlot& slot, const SceneModel& model, const ModelPart& part,
                const glm::dmat4& cameraFromPart);
  void setMaterial(const ModelSlot& slot, const SceneModel& model, const Material& material);
  gpu::Program& programOf(const Material& material);

  Scene scene_;
  gpu::Program background_;
  gpu::Program toon_;
  gpu::Program toonWithHoles_;  // only where a material has holes
  gpu::Texture white_;          // of materials without a texture
  gpu::Buffer vertices_;
  gpu::VertexArrayHandle vertexArray_;
  std::vector<ModelSlot> slots_;
  std::vector<std::size_t> slotOfModel_;
  std::vector<Visible> visible_;

  std::vector<std::unique_ptr<Surfaces>> surfaces_;  // of each size that was composed
  Surfaces* now_ = nullptr;                          // of this frame's size
  std::optional<hal::TimePoint> firstTime_;
  ArFrame frame_;
};

}  // namespace pleinair::scene
