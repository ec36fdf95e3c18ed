#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/render/posed_geometry.h"
#include "pipeline/scene/render/scene_bodies.h"
#include "pipeline/scene/render/screen_area.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::scene {

/// Computes per pixel the motion, the point on the surface, the part and the form (layouts:
/// ArFrame), from the drawn ids and the poses of all bodies in this frame and the previous one.
/// Compute passes work on the visible areas of bodies only, so that drawing itself outputs no more
/// than ids. All calls on the thread of the GL context that it was made in.
class SurfacePass {
 public:
  /// `library` has gpu::sceneShaders(). Both outlive the pass.
  SurfacePass(const gpu::ShaderLibrary& library, const Scene& scene, const PosedGeometry& geometry);

  /// Output textures of one size.
  struct Buffers {
    explicit Buffers(hal::FrameSize size);
    gpu::Texture motion;
    gpu::Texture barycentrics;
    gpu::Texture parts;
    gpu::Texture forms;
    gpu::RenderTarget target;  // all textures, for clearing
    ScreenArea written;        // area that may be non-zero; at first the whole image
    ScreenArea objects;        // of models alone
  };

  /// Runs each program once (docs/gpu.md, rule 14), independent of the bodies' positions.
  /// Precondition: as for run().
  void warmUp(const gpu::Texture& ids, const tracking::CameraModel& camera,
              const SceneBodies& bodies, Buffers& buffers);

  /// `ids` (ArFrame::ids) were drawn through `camera` from the current poses of `geometry`, of
  /// these models. Precondition: all have one size.
  void run(const gpu::Texture& ids, const tracking::CameraModel& camera, const SceneBodies& bodies,
           std::span<const std::size_t> models, Buffers& buffers);

  /// SurfaceAccess::bodies, as of the last run().
  const gpu::Buffer& bodies() const { return bodies_; }

 private:
  /// As in shaders/bodies.glsl.
  struct GpuBody {
    std::array<glm::vec4, 3> current{};
    std::array<glm::vec4, 3> previous{};
    glm::vec4 turnsAbout{0.0F};
    std::array<glm::vec4, 6> errorTurns{};
    std::array<glm::vec4, 6> errorShifts{};
    glm::vec4 extent{0.0F};
    glm::uvec4 places{0U};
    std::array<glm::vec4, 11> padding{};
  };
  static GpuBody gpuBody(const Body& body);
  void writeBodies(const SceneBodies& bodies, std::span<const std::size_t> drawn);
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
  gpu::Program surface_;      // only if there are models
  gpu::Program realSurface_;  // only if there are occluders
  gpu::Program planes_;       // only if there are planes
  gpu::Buffer bodies_;
  std::vector<GpuBody> staged_;
};

}  // namespace pleinair::scene
