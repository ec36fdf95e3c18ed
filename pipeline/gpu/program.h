#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/handle.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"

namespace pleinair::gpu {

/// What a program may bind at once (docs/gpu.md, rule 4).
inline constexpr unsigned kMaxTextureUnits = 16;
inline constexpr unsigned kMaxStorageBuffers = 4;
inline constexpr unsigned kMaxImages = 4;
inline constexpr unsigned kMaxUniformBlocks = 12;
/// Of a dispatch, along each axis: all GPUs take as many (GL ES 3.1, table 20.45).
inline constexpr unsigned kMaxGroups = 65535;
/// Of a uniform block's place in its buffer: no GPU asks for more (GL ES 3.1, table 20.46).
inline constexpr std::size_t kUniformAlignment = 256;

enum class ImageAccess { kRead, kWrite, kReadWrite };

/// A linked program. `use()` binds it; the setters then fill its uniforms and bindings, and one of
/// the draws or dispatch() runs it. Nothing else may use() another program in between. Setting a
/// uniform that the compiler removed does nothing; naming one that the shader never had is the same
/// to GL, so tests compare results, not calls.
class Program {
 public:
  Program() = default;
  Program(ProgramHandle handle, std::string label);

  /// The fragment or compute shader's name.
  const std::string& label() const { return label_; }
  explicit operator bool() const { return static_cast<bool>(handle_); }

  /// Binds the program and forgets the texture units given out before.
  Program& use();

  Program& set(std::string_view uniform, int value);
  Program& set(std::string_view uniform, unsigned value);
  Program& set(std::string_view uniform, float value);
  Program& set(std::string_view uniform, glm::ivec2 value);
  Program& set(std::string_view uniform, glm::vec2 value);
  Program& set(std::string_view uniform, glm::vec3 value);
  Program& set(std::string_view uniform, glm::vec4 value);
  Program& set(std::string_view uniform, const glm::mat3& value);
  Program& set(std::string_view uniform, const glm::mat4& value);
  /// Binds the texture to the next free unit and the sampler to it.
  Program& texture(std::string_view sampler, const Texture& texture);
  /// Binds a storage buffer to `layout(binding = …)`.
  Program& storage(unsigned binding, const Buffer& buffer);
  /// Binds part of a buffer to the uniform block `layout(std140, binding = …)`. Precondition: the
  /// offset is a multiple of kUniformAlignment.
  Program& uniformBlock(unsigned binding, const Buffer& buffer, std::size_t offsetBytes,
                        std::size_t sizeBytes);
  /// Binds a texture as an image to `layout(binding = …)`. RGBA8, RGBA16F, RGBA32F, R32F, R32UI
  /// only, and read-write only the latter two (docs/gpu.md, rule 6).
  Program& image(unsigned binding, const Texture& texture, ImageAccess access);

  /// Runs a full-screen pass over `target`; every pixel is written, no blending, no depth. What was
  /// in the target is lost, its depth too.
  void drawFullscreen(const RenderTarget& target);
  /// Runs the pass over a part of `target` only and keeps the rest.
  void drawArea(const RenderTarget& target, glm::ivec2 origin, hal::FrameSize size);
  /// Runs a compute program over `items` invocations, rounded up to whole groups of `groupSize`,
  /// which is the shader's local_size (at most kMaxGroups of them), then makes its writes visible
  /// to what `barriers` (GL_*_BARRIER_BIT) names.
  void dispatch(glm::ivec2 items, glm::ivec2 groupSize, GLbitfield barriers);

 private:
  void drawTriangle();
  /// Asserts that the program is the current one; -1 for a uniform that is not active.
  GLint location(std::string_view uniform) const;

  struct Uniform {
    std::string name;
    GLint location;
  };
  ProgramHandle handle_;
  std::string label_;
  std::vector<Uniform> uniforms_;
  VertexArrayHandle emptyVertexArray_;
  unsigned nextTextureUnit_ = 0;
};

}  // namespace pleinair::gpu
