#pragma once

#include "pipeline/gpu/program.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::scene {

/// Hides models in a composed frame where real things are known to be before them: there the frame
/// is as if it had no models. All calls on the thread of the GL context that it was made in.
class ModelHiding {
 public:
  /// `library` has gpu::sceneShaders().
  explicit ModelHiding(const gpu::ShaderLibrary& library);

  /// Runs each program once, on pixels of its own (docs/gpu.md, rule 14).
  void warmUp();

  /// `before`: any size, LINEAR; models are hidden where G, sampled over the whole image, is over
  /// 0.5. Changes colour, ids, normalFocus, motion, barycentrics, parts and forms of `frame`, and
  /// leaves depth. Does nothing in a frame without models.
  void hide(const ArFrame& frame, const gpu::Texture& before);

 private:
  gpu::Program picture_;
  gpu::Program surfaces_;
};

}  // namespace pleinair::scene
