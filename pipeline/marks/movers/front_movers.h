#pragma once

#include <memory>

#include "hal/pixel_format.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/movers/busy_blocks.h"
#include "pipeline/scene/render/ar_frame.h"
#include "pipeline/scene/render/model_hiding.h"

namespace pleinair::marks {

/// Tells which movers are before the scene's virtual models: those that cover the place where a
/// model stands, or the tag that it stands on (ArFrame::footprints). What covers the floor under a
/// thing is nearer than the thing's far side, so that a hand that reaches for it is found, and one
/// behind it is not. The whole of a mover goes with such a part, and stays before the models for
/// kStaysSeconds after the last. New ones are found only before a camera that stands: else near
/// things count as movers for their parallax. What covers no such place is behind the models, which
/// may be wrong. All calls on the thread of the GL context that was current at construction.
class FrontMovers {
 public:
  static constexpr float kStaysSeconds = 2.0F;

  /// `cells`: the size of MotionLayers' textures. `library` has gpu::marksShaders(),
  /// gpu::sceneShaders() and gpu::gpuShaders(). Throws hal::Failure if GPU memory runs out.
  FrontMovers(const gpu::ShaderLibrary& library, hal::FrameSize cells);
  ~FrontMovers();
  FrontMovers(const FrontMovers&) = delete;
  FrontMovers& operator=(const FrontMovers&) = delete;
  FrontMovers(FrontMovers&&) = delete;
  FrontMovers& operator=(FrontMovers&&) = delete;

  /// Adds a frame. `labels`, `shares`: MotionLayers' of all of the camera image, also behind
  /// models; `blocks`: where they may be other than 0.
  void update(const scene::ArFrame& frame, const gpu::Texture& labels, const gpu::Texture& shares,
              const BusyBlocks& blocks, bool isStanding, float stepSeconds);
  /// Forgets the past.
  void reset();

  /// RGBA16F, LINEAR, a texel a cell. R: share of kStaysSeconds that the mover there will stay
  /// before the models, 0 for all others. G: 1 where models are to be hidden
  /// (scene::ModelHiding).
  const gpu::Texture& front() const;
  /// The same, for scene::ModelHiding.
  scene::ModelCover cover() const;
  /// The labels of what is seen: 0 where a virtual model is and remains.
  const gpu::Texture& seenLabels() const;
  /// The same of MotionLayers::shares().
  const gpu::Texture& seenShares() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::marks
