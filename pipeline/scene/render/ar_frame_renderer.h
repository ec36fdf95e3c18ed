#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/gpu/per_size.h"
#include "pipeline/gpu/program.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/light/lighting.h"
#include "pipeline/scene/render/ar_frame.h"
#include "pipeline/scene/render/contact_shadow.h"
#include "pipeline/scene/render/posed_geometry.h"
#include "pipeline/scene/render/scene_bodies.h"
#include "pipeline/scene/render/surface_pass.h"
#include "pipeline/scene/scene_shaders.h"

namespace pleinair::scene {

/// Composes AR frames: a scene's models, shaded as a style asks for, and their shadows over the
/// camera's picture.
/// What moves by itself does so by the frames' capture times, counted from the first frame or from
/// the first sight of what it is attached to. Silhouettes are not anti-aliased: each pixel has one
/// object. All calls on the thread of the GL context it was made in.
class ArFrameRenderer {
 public:
  /// Uploads the scene's models. `library` has gpu::gpuShaders() and gpu::sceneShaders().
  /// ArFrame::ids counts models in the scene's order and triangles as their parts do.
  ArFrameRenderer(const gpu::ShaderLibrary& library, Scene scene);
  ArFrameRenderer(const ArFrameRenderer&) = delete;
  ArFrameRenderer& operator=(const ArFrameRenderer&) = delete;
  ArFrameRenderer(ArFrameRenderer&&) = delete;
  ArFrameRenderer& operator=(ArFrameRenderer&&) = delete;
  ~ArFrameRenderer() = default;

  /// Allocates for pictures of `size` and runs each program once, so that the first frame does not
  /// wait for drivers (docs/gpu.md, rule 14).
  void warmUp(hal::FrameSize size);

  /// The next AR frame, valid until the next call and as long as `picture`, which it refers to
  /// where no model is seen. A model is drawn where the pose is known of what it is attached to; a
  /// tag that is hidden is where the world has it. Each size is allocated for once.
  /// `lights`: what is known of the light on the places that models are attached to; elsewhere it
  /// is as the scene says. Precondition: picture (RGBA8, LINEAR) has camera.imageSize() (see
  /// fittedCamera()).
  const ArFrame& compose(const gpu::Texture& picture, const tracking::CameraModel& camera,
                         const PoseSet& poses, std::uint64_t sequence, hal::TimePoint captureTime,
                         ArFrameNeeds needs = {}, std::span<const PlaceLighting> lights = {});

  /// Forgets the frames before: the next one is the first, of which no motion is known and with
  /// which time starts.
  void reset();

 private:
  /// What frames of one size are drawn into.
  struct Surfaces {
    Surfaces(hal::FrameSize size, bool hasModels);

    gpu::Texture ids;
    gpu::Texture normalFocus;
    gpu::Texture depth;
    gpu::Texture colour;                        // where there are models
    gpu::RenderTarget target;                   // all of them
    gpu::RenderTarget withoutColour;            // for frames that show the camera's picture only
    bool showsCameraOnly = false;               // what ids, normals and depth hold
    std::optional<SurfacePass::Buffers> known;  // where they were asked for
  };
  struct Stamp {
    std::uint64_t sequence = 0;
    hal::TimePoint time;
  };
  /// A program each, for branches that are not taken cost as much as those that are.
  struct SurfacePrograms {
    gpu::Program solid;
    gpu::Program alphaMasked;  // only where a material has holes
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
  std::optional<SurfacePass> surfacePass_;  // where there is anything to know
  gpu::Program background_;
  std::optional<ContactShadow> shadow_;             // where a model may cast one
  std::array<SurfacePrograms, 2> surfacePrograms_;  // of each Shading
  gpu::Program occluder_;                           // only where a model is one
  gpu::Texture white_;                              // of materials without a texture
  std::vector<std::size_t> visible_;                // models of this frame
  std::vector<Lighting> lights_;                    // of each model, in the camera's frame
  std::vector<std::uint32_t> objects_;              // ids of all models
  std::optional<tracking::CameraModel> camera_;     // of ArFrame::surfaces
  Shading shading_ = Shading::kToon;
  std::vector<std::optional<hal::TimePoint>> firstSight_;  // of each model
  gpu::PerSize<Surfaces> surfaces_;                        // of each size that was composed
  Surfaces* now_ = nullptr;                                // of this frame's size
  std::optional<hal::TimePoint> firstTime_;
  std::optional<Stamp> before_;  // the frame that bodies and poses were advanced for last
  ArFrame frame_;
};

}  // namespace pleinair::scene
