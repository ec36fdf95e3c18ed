#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "pipeline/gpu/handle.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/light/lighting.h"
#include "pipeline/scene/render/posed_geometry.h"
#include "pipeline/scene/render/scene_bodies.h"
#include "pipeline/scene/render/shadow_casters.h"

namespace pleinair::scene {

/// Soft shadows of models on the plane that they are attached to (z = 0 of the attach frame); they
/// darken the camera image there. Two lights are blocked: the key light, whose shadow falls away
/// from it and gets softer with the height of the caster; and ambient light, close to points of
/// contact. The plane is as large as the shadow. Real objects on the plane or in front of it are
/// unknown, except for occluders, which cover it. Occluders cast no shadow: the camera image has
/// their real ones. Models do not cast shadows on each other.
///
/// There is one shadow map per attach frame, in coordinates of that frame, so that it does not
/// change while the camera moves; it is drawn again only when its models or its light have moved.
/// At most kMaxShadowMaps attach frames, the scene's first ones, have a map. All calls on the
/// thread of the GL context that it was made in.
class ContactShadow {
 public:
  static constexpr std::size_t kMaxShadowMaps = 4;

  /// `library` has gpu::gpuShaders() and gpu::sceneShaders(). Keeps references.
  ContactShadow(const gpu::ShaderLibrary& library, const Scene& scene,
                const PosedGeometry& geometry);

  /// Draws the maps of this frame for the `visible` models, posed, each in its light (camera's
  /// frame).
  void cast(std::span<const std::size_t> visible, const SceneBodies& bodies,
            std::span<const Lighting> cameraLights);

  /// Runs each program once (docs/gpu.md, rule 14). Precondition: the render target is bound, the
  /// receiver has its camera, and all models are posed.
  void warmUp();

  /// Forgets the maps of previous frames.
  void reset();

  /// The program of draw(), for setting the camera's vertex uniforms.
  gpu::Program& receiver() { return receive_; }
  /// Multiplies the shadows into the first of the bound target's three colour attachments, which
  /// must show the camera image alone.
  void draw();

 private:
  struct Map {
    Map();
    std::optional<int> tagId;
    gpu::Texture heights;  // RG8: whether anything is over the plane, and its height
    gpu::Texture depth;
    gpu::Texture halfBlurred;
    gpu::Texture blurred;  // RG8: the blocked share of key and ambient light
    gpu::RenderTarget castTarget, halfTarget, target;
    std::optional<ShadowPlan> plan;
    std::vector<glm::dmat4> casters;  // poses in the map: of its models, in the attach frame
    double contactHeight = 0.0;
    // State in this frame.
    bool isShown = false;
    glm::dmat4 cameraFromAttach{1.0};
    Lighting light;
  };
  void castMap(Map& map, std::span<const std::size_t> visible, const SceneBodies& bodies,
               std::span<const Lighting> cameraLights);
  bool isUpToDate(const Map& map, const ShadowPlan& plan) const;
  void drawCasters(const Map& map);
  void blur(const Map& map);

  const Scene& scene_;
  const PosedGeometry& geometry_;
  ShadowCasters casters_;
  gpu::Program cast_;
  gpu::Program blurAcross_;
  gpu::Program blurDown_;
  gpu::Program receive_;
  gpu::VertexArrayHandle noAttributes_;
  std::vector<Map> maps_;
  // Scratch data for one map, kept to reuse memory.
  std::vector<std::size_t> objects_;
  std::vector<glm::dmat4> poses_;
  std::vector<BoundingSphere> spheres_;
};

}  // namespace pleinair::scene
