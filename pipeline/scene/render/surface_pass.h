#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/program.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/render/posed_geometry.h"
#include "pipeline/scene/render/scene_bodies.h"
#include "pipeline/scene/render/screen_area.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::scene {

/// Finds, from what was drawn and from where all bodies are and were, each pixel's motion, its
/// point on the surface and its part (ArFrame has the layouts). Compute passes that work on what is
/// seen, where it is, so that drawing itself carries no more than ids. All calls on the thread of
/// the GL context it was made in.
class SurfacePass {
 public:
  /// `library` has gpu::sceneShaders(). Both outlive the pass.
  SurfacePass(const gpu::ShaderLibrary& library, const Scene& scene, const PosedGeometry& geometry);

  /// What it writes, of one size.
  struct Buffers {
    explicit Buffers(hal::FrameSize size);
    gpu::Texture motion;
    gpu::Texture barycentrics;
    gpu::Texture parts;
    gpu::RenderTarget target;  // all of them, to be cleared
    ScreenArea written;        // what may be other than 0; at first all
  };

  /// Runs each program once (docs/gpu.md, rule 14), wherever models and planes are. Precondition:
  /// as of run().
  void warmUp(const gpu::Texture& ids, const tracking::CameraModel& camera,
              const SceneBodies& bodies, Buffers& buffers);

  /// `ids` (ArFrame::ids) were drawn through `camera` from `geometry` as it is posed now, of these
  /// models. Precondition: all have one size.
  void run(const gpu::Texture& ids, const tracking::CameraModel& camera, const SceneBodies& bodies,
           std::span<const std::size_t> models, Buffers& buffers);

  /// SurfaceAccess::bodies, as of the last run().
  const gpu::Buffer& bodies() const { return bodies_; }

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
    std::array<glm::vec4, 11> padding{};
  };
  static GpuBody gpuBody(const Body& body);
  void writeBodies(const SceneBodies& bodies);
  ScreenArea areaOfModel(std::size_t index, const Body& body,
                         const tracking::CameraModel& camera) const;
  ScreenArea areaOfPlanes(const SceneBodies& bodies, const tracking::CameraModel& camera) const;
  static void clear(Buffers& buffers);
  void runPlanes(const gpu::Texture& ids, const tracking::CameraModel& camera,
                 const ScreenArea& area, const Buffers& buffers);
  void runModel(gpu::Program& program, std::size_t index, const gpu::Texture& ids,
                const tracking::CameraModel& camera, const ScreenArea& area,
                const Buffers& buffers);
  gpu::Program& begin(gpu::Program& program, const gpu::Texture& ids,
                      const tracking::CameraModel& camera, const ScreenArea& area);

  const Scene& scene_;
  const PosedGeometry& geometry_;
  gpu::Program surface_;      // only where there are models
  gpu::Program realSurface_;  // only where there are occluders
  gpu::Program planes_;       // only where there are planes
  gpu::Buffer bodies_;
  std::vector<GpuBody> staged_;
};

}  // namespace pleinair::scene
