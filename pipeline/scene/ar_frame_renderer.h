#pragma once

#include <cstdint>
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
/// Silhouettes are not anti-aliased: each pixel has one object. All calls on the thread of the GL
/// context it was made in.
class ArFrameRenderer {
 public:
  /// Uploads the scene's meshes. `library` has gpu::sceneShaders(). ArFrame::ids counts models in
  /// the scene's order and triangles in their meshes' order.
  ArFrameRenderer(const gpu::ShaderLibrary& library, Scene scene);

  /// Allocates for pictures of `size` and runs each program once, so that the first frame does not
  /// wait for drivers (GPU.md, rule 14).
  void warmUp(hal::FrameSize size);

  /// The next AR frame, valid until the next call and as long as `picture`, which it refers to
  /// where no model is seen. A model is drawn where the pose is known of what it is attached to; a
  /// tag that is hidden is where the world has it. No allocation while the size stays.
  /// Precondition: picture (RGBA8, LINEAR) has camera.imageSize() (see fittedCamera()).
  const ArFrame& compose(const gpu::Texture& picture, const tracking::CameraModel& camera,
                         const PoseSet& poses, std::uint64_t sequence, hal::TimePoint captureTime,
                         gpu::PassTimer& timer);

 private:
  /// A mesh's place in the vertex buffer.
  struct MeshSlot {
    const Mesh* mesh = nullptr;
    GLint firstVertex = 0;
    GLsizei vertexCount = 0;
    BoundingSphere sphere;
  };
  /// A model in this frame.
  struct Visible {
    std::size_t model = 0;
    glm::dmat4 cameraFromAttach{1.0};
    glm::dmat4 cameraFromModel{1.0};
  };

  void uploadMeshes();
  void allocate(hal::FrameSize size);
  void findVisible(const PoseSet& poses);
  void clearToCamera();
  void drawBackground(const gpu::Texture& picture);
  void setCamera(const tracking::CameraModel& camera);
  void drawModels();
  void drawModel(const Visible& visible);

  Scene scene_;
  gpu::Program background_;
  gpu::Program toon_;
  gpu::Buffer vertices_;
  gpu::VertexArrayHandle vertexArray_;
  std::vector<MeshSlot> meshes_;
  std::vector<std::size_t> meshOfModel_;
  std::vector<Visible> visible_;

  gpu::Texture colour_;
  gpu::Texture ids_;
  gpu::Texture normalFocus_;
  gpu::Texture depth_;
  gpu::RenderTarget target_;         // all of them
  gpu::RenderTarget withoutColour_;  // for frames that show the camera's picture only
  bool showsCameraOnly_ = false;     // what ids, normals and depth hold
  ArFrame frame_;
};

}  // namespace pleinair::scene
