#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "pipeline/gpu/handle.h"
#include "pipeline/gpu/programs/program.h"

namespace pleinair::embedded_gpu {

/// Uses programs once in recorded states, with small textures, targets and buffers of the recorded
/// formats, so that a driver compiles the variant that the state asks for. Belongs to the current
/// context.
class ReplayedState {
 public:
  ReplayedState();

  /// Draws or dispatches once and waits. Throws hal::Failure where a format is unknown, a target is
  /// incomplete or GL reports an error.
  void use(gpu::Program& program, const nlohmann::json& state);

 private:
  /// One of several textures of this format: the same one for the same `which`.
  GLuint textureOf(const std::string& format, int which = 0);
  void bindUniforms(GLuint program, const nlohmann::json& state);
  void bindTargets(const nlohmann::json& state);
  void bindAttributes(const nlohmann::json& state);
  void draw(const nlohmann::json& state);

  std::map<std::pair<std::string, int>, gpu::TextureHandle> textures_;
  gpu::BufferHandle buffer_;
  gpu::FramebufferHandle framebuffer_;
  gpu::VertexArrayHandle vertexArray_;
};

}  // namespace pleinair::embedded_gpu
