#pragma once

#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::styles {

/// The paper or linen under a painting. It moves with the image as a whole, so that it neither
/// looks like a dirty window before the scene nor slides under it, and its grain keeps its size on
/// the screen under any zoom: two octaves of it blend into each other (Cunzi et al., "Dynamic
/// canvas for immersive non-photorealistic walkthroughs", 2003). All calls on the thread of the GL
/// context.
class Substrate {
 public:
  enum class Kind { kPaper, kLinen };
  /// `library` has gpu::substrateShaders() and gpu::gpuShaders().
  Substrate(const gpu::ShaderLibrary& library, Kind kind);

  /// One tile of it, repeating: RGBA8, as shaders/paper.frag and linen.frag have it.
  const gpu::Texture& tile() const { return tile_; }
  /// Binds what shaders/substrate.glsl reads. Precondition: the program is in use.
  void bind(gpu::Program& program, const scene::ArFrame& frame) const;

 private:
  gpu::Texture tile_;
};

}  // namespace pleinair::styles
