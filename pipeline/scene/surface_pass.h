#pragma once

#include <array>
#include <vector>

#include <glm/vec4.hpp>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/program.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/posed_geometry.h"
#include "pipeline/scene/scene.h"
#include "pipeline/scene/scene_bodies.h"
#include "pipeline/tracking/camera_model.h"

namespace pleinair::scene {

/// Finds, from what was drawn and from where all bodies are and were, each pixel's motion, its
/// point on the surface and its part (ArFrame has the layouts). One compute pass that works on what
/// is seen, so that drawing itself carries no more than ids. All calls on the thread of the GL
/// context it was made in.
class SurfacePass {
 public:
  /// `library` has gpu::sceneShaders(). Both outlive the pass.
  SurfacePass(const gpu::ShaderLibrary& library, const Scene& scene, const PosedGeometry& geometry);

  struct Buffers {
    gpu::Texture motion;
    gpu::Texture barycentrics;
    gpu::Texture parts;
  };
  /// The buffers of one size.
  static Buffers makeBuffers(hal::FrameSize size);

  /// `ids` (ArFrame::ids) were drawn through `camera` from `geometry` as it is posed now.
  /// Precondition: all have one size.
  void run(const gpu::Texture& ids, const tracking::CameraModel& camera, const SceneBodies& bodies,
           const Buffers& buffers);

 private:
  /// shaders/bodies.glsl.
  struct GpuBody {
    std::array<glm::vec4, 3> now{};
    std::array<glm::vec4, 3> then{};
    glm::vec4 turnsAbout{0.0F};
    std::array<glm::vec4, 6> errorTurns{};
    std::array<glm::vec4, 6> errorShifts{};
    glm::vec4 extent{0.0F};
    glm::uvec4 places{0U};
  };
  static GpuBody gpuBody(const Body& body);
  void writeBodies(const SceneBodies& bodies);

  const Scene& scene_;
  const PosedGeometry& geometry_;
  gpu::Program program_;
  gpu::Buffer bodies_;
  gpu::Buffer nothing_;  // in place of the vertices of a scene of planes
  std::vector<GpuBody> staged_;
};

}  // namespace pleinair::scene
