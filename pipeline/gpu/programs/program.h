#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
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
#include "pipeline/gpu/programs/list_dispatch.h"
#include "pipeline/gpu/programs/pass_form.h"
#include "pipeline/gpu/programs/pass_timer.h"
#include "pipeline/gpu/programs/shader_interface.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"

namespace pleinair::gpu {

/// The limits of one program's bindings (docs/gpu.md, rule 4).
inline constexpr unsigned kMaxTextureUnits = 16;
inline constexpr unsigned kMaxStorageBuffers = 4;
inline constexpr unsigned kMaxImages = 4;
inline constexpr unsigned kMaxUniformBlocks = 12;
/// Groups of a dispatch along each axis that every GPU accepts (GL ES 3.1, table 20.45).
inline constexpr unsigned kMaxGroups = 65535;
/// Alignment of a uniform block in its buffer; no GPU requires more (GL ES 3.1, table 20.46).
inline constexpr std::size_t kUniformAlignment = 256;

enum class ProgramKind { kDraw, kCompute };
enum class ImageAccess { kRead, kWrite, kReadWrite };

/// A linked program. `use()` binds it; the setters then fill its uniforms and bindings, and one of
/// the draws or dispatch() runs it. Nothing else may use() another program in between.
///
/// It knows the names that its shaders declare: the setters throw hal::Failure (kInternal, with all
/// names) for a name that is none of them, or is of another kind or type. A declared name that the
/// compiler removed, because nothing depends on it, may be set and does nothing.
///
/// Copies share the linked program and with it the values of its uniforms, which last until any
/// copy sets them: after use(), fill all that the run reads, or be the only user of the program.
///
/// Each draw and dispatch is timed under pass() where the ShaderLibrary that it is from has a
/// timer.
class Program {
 public:
  /// Where a library keeps the timer of all its programs.
  using TimerSlot = std::shared_ptr<PassTimer*>;

  Program() = default;
  /// `inputs` are all that its shaders' texts declare. `targets`: of a full-screen pass in its
  /// compute form (PassForm), the formats of what it writes to. `listDispatch`: of
  /// dispatchListed().
  Program(ProgramHandle handle, ProgramKind kind, std::string label,
          std::vector<ShaderInput> inputs, TimerSlot timer, PassTargets targets = {},
          ListDispatch listDispatch = ListDispatch::kIndirect);

  /// The fragment or compute shader's name, with the defines that it was made with.
  const std::string& label() const;
  /// The name that it is timed under: its shader's folder and file, "watercolor: guide".
  const std::string& pass() const;
  /// Whether its shaders declare a uniform or sampler of this name: for code that fills several
  /// programs alike.
  bool hasUniform(std::string_view name) const;
  explicit operator bool() const { return linked_ != nullptr; }
  /// The local_size of a compute program.
  glm::ivec2 groupSize() const;

  /// Binds the program and forgets the texture units given out before.
  Program& use();

  Program& set(std::string_view uniform, int value);
  Program& set(std::string_view uniform, unsigned value);
  Program& set(std::string_view uniform, float value);
  Program& set(std::string_view uniform, glm::ivec2 value);
  Program& set(std::string_view uniform, glm::vec2 value);
  Program& set(std::string_view uniform, glm::vec3 value);
  Program& set(std::string_view uniform, glm::vec4 value);
  /// Of an array: its first elements. Precondition: one at least, and no more than it has.
  Program& set(std::string_view uniform, std::span<const glm::vec4> values);
  Program& set(std::string_view uniform, const glm::mat3& value);
  Program& set(std::string_view uniform, const glm::mat4& value);
  /// Binds the texture to the next free unit and the sampler to it.
  Program& texture(std::string_view sampler, const Texture& texture);
  /// Binds a storage buffer to the block `layout(std430, binding = …) buffer NAME`.
  Program& storage(std::string_view block, const Buffer& buffer);
  /// Binds part of a buffer to the block `layout(std140, binding = …) uniform NAME`. Precondition:
  /// the offset is a multiple of kUniformAlignment.
  Program& uniformBlock(std::string_view block, const Buffer& buffer, std::size_t offsetBytes,
                        std::size_t sizeBytes);
  /// Binds a texture to an image `layout(binding = …)`. RGBA8, RGBA16F, RGBA32F, R32F, R32UI only,
  /// and read-write only the latter two (docs/gpu.md, rule 6).
  Program& image(std::string_view name, const Texture& texture, ImageAccess access);

  /// Runs a full-screen pass over `target`; every pixel is written, no blending, no depth. What was
  /// in the target is lost, its depth too. Precondition: the target has the formats that a pass in
  /// its compute form was made for.
  void drawFullscreen(const RenderTarget& target);
  /// Runs the pass over a part of `target` only and keeps the rest. Not in its compute form. With
  /// `command`, the GPU decides whether: it is glDrawArraysIndirect's (shaders/draw_command.glsl),
  /// of 3 vertices and one instance or none, written before with GL_COMMAND_BARRIER_BIT among its
  /// barriers.
  void drawArea(const RenderTarget& target, glm::ivec2 origin, hal::FrameSize size,
                const Buffer* command = nullptr);
  /// Runs a compute program over `items` invocations, rounded up to whole groups (at most
  /// kMaxGroups along each axis), then makes its writes visible to what `barriers`
  /// (GL_*_BARRIER_BIT) names.
  void dispatch(glm::ivec2 items, GLbitfield barriers);
  /// Runs a compute program over as many groups as the GPU finds at `offsetBytes` of `commands`:
  /// three 32-bit counts, written before with GL_COMMAND_BARRIER_BIT among their barriers. None
  /// runs where one of them is 0.
  void dispatchIndirect(const Buffer& commands, std::size_t offsetBytes, GLbitfield barriers);
  /// The same for a program that itself returns in groups beyond the command, with
  /// ListDispatch::kAllGroups over `mostGroups`.
  void dispatchListed(const Buffer& commands, std::size_t offsetBytes, glm::ivec2 mostGroups,
                      GLbitfield barriers);
  /// Groups that dispatch() would run for so many items.
  glm::ivec2 groupsFor(glm::ivec2 items) const;
  /// Times GL calls of the caller's own, which draw with this program, while the scope lives.
  [[nodiscard]] PassTimer::Scope measure() const;

 private:
  void dispatchGroups(glm::ivec2 groups, GLbitfield barriers);
  struct Input {
    ShaderInput declared;
    GLint location = -1;  // of uniforms and samplers that the compiler kept
  };
  struct Linked;

  /// Draws one instance, or as many as `command` holds.
  void drawTriangle(const Buffer* command);
  const Input& input(ShaderInput::Kind kind, std::string_view name) const;
  /// Asserts that the program is the current one; -1 for a uniform that the compiler removed.
  GLint location(std::string_view uniform, std::string_view type) const;
  unsigned binding(ShaderInput::Kind kind, std::string_view name) const;
  [[noreturn]] void refuse(const std::string& problem) const;

  std::shared_ptr<const Linked> linked_;
  TimerSlot timer_;
  unsigned nextTextureUnit_ = 0;
};

}  // namespace pleinair::gpu
