#pragma once

#include <cassert>
#include <utility>

#include <EGL/egl.h>

#include "hal/error.h"
#include "pipeline/gpu/gl.h"
#include "pipeline/gpu/gpu_loss.h"

namespace pleinair::gpu {

/// While one lives, the objects that go on this thread are left in their context as they are: for
/// one that is lost, whose driver is not to be called. It may be current or not.
class ContextLossGuard {
 public:
  ContextLossGuard();
  ~ContextLossGuard();
  ContextLossGuard(const ContextLossGuard&) = delete;
  ContextLossGuard& operator=(const ContextLossGuard&) = delete;

  static bool isInForce();
};

/// Owns one GL object's name. Made, used and destroyed with the same context current, which is
/// asserted. `Traits` has create() and destroy(GLuint).
template <class Traits>
class Handle {
 public:
  /// Holds nothing.
  Handle() = default;
  static Handle make() { return Handle(Traits::create()); }
  explicit Handle(GLuint name) : name_(name), context_(eglGetCurrentContext()) {}
  Handle(Handle&& other) noexcept
      : name_(std::exchange(other.name_, 0)), context_(other.context_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(name_, other.name_);
    std::swap(context_, other.context_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (name_ == 0 || ContextLossGuard::isInForce()) return;
    assert(eglGetCurrentContext() == context_);
    Traits::destroy(name_);
  }

  GLuint get() const {
    assert(name_ == 0 || eglGetCurrentContext() == context_);
    return name_;
  }
  explicit operator bool() const { return name_ != 0; }

 private:
  GLuint name_ = 0;
  EGLContext context_ = EGL_NO_CONTEXT;
};

/// Traits of the kinds whose names come from glGen* and go with glDelete*.
template <void (*Generate)(GLsizei, GLuint*), void (*Delete)(GLsizei, const GLuint*)>
struct GeneratedName {
  static GLuint create() {
    GLuint name = 0;
    Generate(1, &name);
    return name;
  }
  static void destroy(GLuint name) { Delete(1, &name); }
};

using TextureHandle = Handle<GeneratedName<glGenTextures, glDeleteTextures>>;
using BufferHandle = Handle<GeneratedName<glGenBuffers, glDeleteBuffers>>;
using FramebufferHandle = Handle<GeneratedName<glGenFramebuffers, glDeleteFramebuffers>>;
using VertexArrayHandle = Handle<GeneratedName<glGenVertexArrays, glDeleteVertexArrays>>;
using QueryHandle = Handle<GeneratedName<glGenQueries, glDeleteQueries>>;

struct ProgramName {
  static GLuint create() { return glCreateProgram(); }
  static void destroy(GLuint name) { glDeleteProgram(name); }
};
using ProgramHandle = Handle<ProgramName>;

struct ShaderName {
  static void destroy(GLuint name) { glDeleteShader(name); }
};
using ShaderHandle = Handle<ShaderName>;

enum class FenceState {
  kSignalled,
  kNotYet,
  kFailed,  ///< it will never be: the GPU or its context is lost
};

/// A point in the GPU's command stream that can be asked about or waited for.
class Fence {
 public:
  Fence() = default;
  /// A fence after everything that was issued so far.
  static Fence insert() {
    Fence fence;
    fence.sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    fence.context_ = eglGetCurrentContext();
    return fence;
  }
  Fence(Fence&& other) noexcept
      : sync_(std::exchange(other.sync_, nullptr)), context_(other.context_) {}
  Fence& operator=(Fence&& other) noexcept {
    std::swap(sync_, other.sync_);
    std::swap(context_, other.context_);
    return *this;
  }
  Fence(const Fence&) = delete;
  Fence& operator=(const Fence&) = delete;
  ~Fence() {
    if (sync_ == nullptr || ContextLossGuard::isInForce()) return;
    assert(eglGetCurrentContext() == context_);
    glDeleteSync(sync_);
  }

  explicit operator bool() const { return sync_ != nullptr; }
  /// How it stands, after waiting `timeoutNs` at most. Flushes, so that it is reached. An empty
  /// one, as a driver gives that has lost its GPU, has failed.
  FenceState state(GLuint64 timeoutNs = 0) const { return state(timeoutNs, {}); }
  /// Whether the GPU has passed it, after waiting for it `limit` of real time at most. Error:
  /// kDeviceLost, where it never will.
  hal::Answer passed(const GpuTestHook& testHook = {}, hal::Duration limit = {}) const;
  /// Returns when the GPU has passed it. Error: kDeviceLost, where it never will or does not within
  /// the testHook's patience.
  hal::Result<void> wait(const GpuTestHook& testHook = {}) const;

 private:
  FenceState state(GLuint64 timeoutNs, const GpuTestHook& testHook) const;

  GLsync sync_ = nullptr;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace pleinair::gpu
