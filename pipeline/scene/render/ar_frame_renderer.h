#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/gpu/images/per_size.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/light/lighting.h"
#include "pipeline/scene/render/ar_frame.h"
#include "pipeline/scene/render/contact_shadow.h"
#include "pipeline/scene/render/posed_geometry.h"
#include "pipeline/scene/render/scene_bodies.h"
#include "pipeline/scene/render/surface_pass.h"
#include "pipeline/scene/render/surface_snapshot.h"
#include "pipeline/scene/scene_shaders.h"

namespace pleinair::scene {

/// Composes AR frames: draws a scene's models, shaded as a style asks, and their shadows over the
/// camera image. Animations follow the frames' capture times, counted from the first frame or from
/// the first sight of the tag that the model is attached to. Silhouettes are not anti-aliased: each
/// pixel has one object. All calls on the thread of the GL context that it was made in.
class ArFrameRenderer {
 public:
  /// Uploads the scene's models. `library` has gpu::gpuShaders() and gpu::sceneShaders().
  /// ArFrame::ids number models in the scene's order, and triangles in their parts' order.
  ArFrameRenderer(const gpu::ShaderLibrary& library, Scene scene);
  ArFrameRenderer(const ArFrameRenderer&) = delete;
  ArFrameRenderer& operator=(const ArFrameRenderer&) = delete;
  ArFrameRenderer(ArFrameRenderer&&) = delete;
  ArFrameRenderer& operator=(ArFrameRenderer&&) = delete;
  ~ArFrameRenderer() = default;

  /// Allocates for images of `size` and runs each program once, so that the first frame does not
  /// wait for the driver (docs/gpu.md, rule 14).
  void warmUp(hal::FrameSize size);

  /// Composes the next AR frame. It is valid until the next call and as long as `picture`, to which
  /// it refers where no model is visible. A model is drawn where the pose of its tag or the world
  /// is known; the pose of a hidden tag is computed from the world's. Each size is allocated once.
  /// `lights`: estimated light per place; other places have the scene's light. Precondition:
  /// picture (RGBA8, LINEAR) has the size camera.imageSize() (see fittedCamera()).
  const ArFrame& compose(const gpu::Texture& picture, const tracking::CameraModel& camera,
                         const PoseSet& poses, std::uint64_t sequence, hal::TimePoint captureTime,
                         ArFrameNeeds needs = {}, std::span<const PlaceLighting> lights = {});

  /// From the next frame on, parts of a model (index in the scene) whose byte is not 0 are not
  /// there (PosedGeometry::hideParts()).
  void hideParts(std::size_t model, std::span<const std::uint8_t> hidden) {
    geometry_.hideParts(model, hidden);
  }
  /// Where a model was drawn in the last frame; nothing where its pose was unknown.
  const std::optional<Body::Moment>& placeOf(std::size_t model) const {
    return bodies_.model(model).current;
  }

  /// Reads which points of the models the last frame shows, for measures and tests; waits for the
  /// GPU. Precondition: a frame was composed, and asked for surfaces.
  SurfaceSnapshot snapshot();

  /// Forgets the previous frames: the next one is the first, has no motion, and restarts the time.
  void reset();

 private:
  /// Render targets for frames of one size.
  struct Surfaces {
    Surfaces(hal::FrameSize pictureSize, bool hasModels, bool hasPlanes);

    hal::FrameSize size;
    gpu::Texture ids;
    gpu::Texture normalFocus;
    gpu::Texture depth;
    gpu::Texture colour;              // where there are models
    gpu::RenderTarget target;         // all attachments
    gpu::RenderTarget withoutColour;  // for frames that show only the camera image
    bool showsCameraOnly = false;     // whether ids, normals and depth hold only the camera
    std::optional<SurfacePass::Buffers> buffers;  // if asked for
  };
  struct Stamp {
    std::uint64_t sequence = 0;
    hal::TimePoint time;
  };
  /// One program per variant: branches that are not taken cost as much as those that are.
  struct SurfacePrograms {
    gpu::Program solid;
    gpu::Program alphaMasked;  // only if a material has holes
  };
  SurfacePrograms& programsOf(Shading shading) {
    return surfacePrograms_[static_cast<std::size_t>(shading)];
  }
  void makePrograms(const gpu::ShaderLibrary& library);
  void takeSurfaces(hal::FrameSize size);
  void poseModels(hal::TimePoint captureTime);
  void drawFrame(const gpu::Texture& picture, const tracking::CameraModel& camera);
  void findVisible();
  void findLights(std::span<const PlaceLighting> lights);
  void findFoci(const PoseSet& poses, const tracking::CameraModel& camera);
  void clearToCamera();
  void drawBackground(const gpu::Texture& picture);
  void setCamera(const tracking::CameraModel& camera);
  void drawModels(const gpu::Texture& picture);
  void drawModel(std::size_t index, const gpu::Texture& picture);
  gpu::Program& beginModel(gpu::Program& program, std::size_t index);
  void setMaterial(gpu::Program& program, std::size_t index, const Material& material);
  void findSurfaces(const tracking::CameraModel& camera);

  Scene scene_;
  PosedGeometry geometry_;
  SceneBodies bodies_;
  std::optional<SurfacePass> surfacePass_;  // only if there are bodies
  gpu::Program background_;
  std::optional<ContactShadow> shadow_;              // only if a model may cast a shadow
  std::array<SurfacePrograms, 2> surfacePrograms_;   // per Shading
  gpu::Program occluder_;                            // only if a model is one
  gpu::Texture white_;                               // for materials without a texture
  std::vector<std::size_t> visible_;                 // models of this frame
  std::vector<Lighting> lights_;                     // per model, in the camera's frame
  std::vector<std::uint32_t> objects_;               // ids of all models
  std::optional<tracking::CameraModel> camera_;      // for ArFrame::surfaces
  std::vector<std::optional<FocusPlace>> lastFoci_;  // of all foci; nothing: never seen
  std::vector<FocusPlace> foci_;                     // for ArFrame::foci
  std::vector<Footprint> footprints_;                // for ArFrame::footprints
  Shading shading_ = Shading::kToon;
  std::vector<std::optional<hal::TimePoint>> firstSight_;  // per model
  gpu::PerSize<Surfaces> surfaces_;                        // per composed size
  Surfaces* surfacesNow_ = nullptr;                        // of this frame's size
  std::optional<hal::TimePoint> firstTime_;
  std::optional<Stamp> lastStamp_;  // the frame for which bodies and poses were last advanced
  ArFrame frame_;
  SurfaceReader reader_;
};

}  // namespace pleinair::scene
