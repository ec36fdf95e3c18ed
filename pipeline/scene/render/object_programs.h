#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::scene {

/// A program whose shader includes shaders/has_objects.glsl, in two variants: for scenes with
/// models, and a smaller one for those without (NO_OBJECTS). Software renderers run both sides of a
/// branch, and compilers keep registers for both. Each is made when it is first used: a scene has
/// models or it has none. On the thread of the GL context.
class ObjectPrograms {
 public:
  /// `make` makes a variant. The ShaderLibrary that it refers to outlives this.
  explicit ObjectPrograms(std::function<gpu::Program(const gpu::ShaderDefines&)> make)
      : make_(std::move(make)) {}

  /// The variant for the frame's scene, in use, with hasObjects set.
  gpu::Program& use(const ArFrame& frame) {
    const bool may = frame.mayHaveObjects();
    std::optional<gpu::Program>& program = may ? forModels_ : forNone_;
    if (!program) program = make_(may ? gpu::ShaderDefines{} : gpu::ShaderDefines{{"NO_OBJECTS"}});
    program->use();
    if (may) program->set("hasObjects", frame.hasObjects ? 1 : 0);
    return *program;
  }

 private:
  std::function<gpu::Program(const gpu::ShaderDefines&)> make_;
  std::optional<gpu::Program> forModels_;
  std::optional<gpu::Program> forNone_;
};

}  // namespace pleinair::scene
