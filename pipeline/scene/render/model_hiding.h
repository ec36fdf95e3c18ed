#pragma once

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::scene {

/// Where real things are known to be before models.
struct ModelCover {
  const gpu::Texture* places;  ///< any size, LINEAR: sampled over the whole image, G over 0.5
  /// glDrawArraysIndirect's command: 3 vertices, and no instance if there is no such place.
  const gpu::Buffer* command;
};

/// Hides models in a composed frame where real things are known to be before them: there the frame
/// is as if it had no models. All calls on the thread of the GL context that it was made in.
class ModelHiding {
 public:
  /// `library` has gpu::sceneShaders().
  explicit ModelHiding(const gpu::ShaderLibrary& library);

  /// Runs each program once, on pixels of its own (docs/gpu.md, rule 14).
  void warmUp();

  /// Changes colour, ids, normalFocus, motion, barycentrics, parts and forms of `frame`, and
  /// leaves depth. Does nothing in a frame without models.
  void hide(const ArFrame& frame, const ModelCover& before);

 private:
  gpu::Program picture_;
  gpu::Program surfaces_;
};

}  // namespace pleinair::scene
