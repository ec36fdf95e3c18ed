#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "pipeline/gpu/handle.h"
#include "pipeline/gpu/program.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/light/lighting.h"
#include "pipeline/scene/render/posed_geometry.h"
#include "pipeline/scene/render/scene_bodies.h"
#include "pipeline/scene/render/shadow_casters.h"

namespace pleinair::scene {

/// Soft shadows of models on the plane of what they are attached to (their attach frame's z = 0),
/// darkening the camera's picture there. Two lights are kept off: the key light, whose shadow falls
/// away from it and grows softer with the height of what casts it; and the ambient light, close to
/// what touches the plane. The plane has no end but the shadow's own; whether something real lies
/// on it or before it is not known, except for occluders, which cover it. Occluders cast none: the
/// camera sees their real ones. Models do not cast shadows on each other.
///
/// A map for each attach frame, in coordinates of that frame, so that it keeps still while the
/// camera moves; drawn again only when its models or its light have moved. At most kMostMaps attach
/// frames have one, the scene's first. All calls on the thread of the GL context it was made in.
class ContactShadow {
 public:
  static constexpr std::size_t kMostMaps = 4;

  /// `library` has gpu::gpuShaders() and gpu::sceneShaders(). Keeps references.
  ContactShadow(const gpu::ShaderLibrary& library, const Scene& scene,
                const PosedGeometry& geometry);

  /// Draws the maps for this frame: of `visible` models, posed, in the light of each (camera's
  /// frame).
  void cast(std::span<const std::size_t> visible, const SceneBodies& bodies,
            std::span<const Lighting> cameraLights);

  /// Runs each program once (docs/gpu.md, rule 14); the target that draws go to is bound, the
  /// receiver has its camera, and all models are posed.
  void warmUp();

  /// Forgets the maps of the frames before.
  void reset();

  /// What draw() needs of the camera, for its program: the uniforms of a camera's vertices.
  gpu::Program& receiver() { return receive_; }
  /// Multiplies the shadows into the first of the bound target's three colour attachments, which
  /// shows the camera's picture alone.
  void draw();

 private:
  struct Map {
    Map();
    std::optional<int> tagId;
    gpu::Texture heights;  // RG8: whether something is over the plane, and how high
    gpu::Texture depth;
    gpu::Texture halfBlurred;
    gpu::Texture blurred;  // RG8: the share of key and ambient light that is kept off
    gpu::RenderTarget castTarget, halfTarget, target;
    std::optional<ShadowPlan> plan;
    std::vector<glm::dmat4> casters;  // what it holds: where its models were, in the attach frame
    double contactHeight = 0.0;
    // Of this frame.
    bool isShown = false;
    glm::dmat4 cameraFromAttach{1.0};
    Lighting light;
  };
  void castOne(Map& map, std::span<const std::size_t> visible, const SceneBodies& bodies,
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
  // Of the map at hand; kept for their memory.
  std::vector<std::size_t> objects_;
  std::vector<glm::dmat4> poses_;
  std::vector<BoundingSphere> spheres_;
};

}  // namespace pleinair::scene
