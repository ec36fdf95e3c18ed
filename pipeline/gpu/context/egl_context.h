#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "hal/error.h"
#include "hal/pixel_format.h"

namespace pleinair::gpu {

/// The GPU and driver of the current context.
struct ContextInfo {
  std::string renderer;  ///< "llvmpipe (LLVM 15.0.6, 256 bits)"
  std::string version;   ///< "OpenGL ES 3.2 Mesa 22.3.6"
  /// How the display was opened: "surfaceless", "device", "gbm", "window", "host".
  std::string platform;
  std::string apartBecause;  ///< why it is not on the display that was asked for, if one was
  bool isSoftware = false;   ///< its timer queries are wrong (docs/gpu.md, rule 13)
  bool hasTimerQuery = false;
  bool tellsOfResets = false;  ///< or else a lost GPU shows only where something fails
  int maxSidePixels = 0;       ///< of textures and of what can be drawn into
};

/// An OpenGL ES 3.1 context of our own, without a window system, that tells of resets where the
/// driver can. It belongs to the thread that made it: there it is current from the beginning, made
/// current again with makeCurrent() where another one took its place, and destroyed while it is
/// current. In builds with assertions, a GL error in it aborts with the driver's message: it is
/// always a broken contract of ours.
class EglContext {
 public:
  /// Tries EGL's surfaceless platform, then its devices, then GBM on the render nodes, and takes
  /// the first that is hardware, or software where none is or LIBGL_ALWAYS_SOFTWARE asks for it.
  /// Throws hal::Failure (kUnsupported) that names what each of them answered.
  /// `windows`: an EGLDisplay of a window system, which is tried before these and so shares
  /// textures with its windows. It is initialised, outlives this and is left to its owner. Null:
  /// none.
  explicit EglContext(void* windows = nullptr);
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  const ContextInfo& info() const;
  bool isCurrent() const;
  /// Makes it current on the thread that made it; false where the driver refuses, as it may once
  /// the context is lost.
  bool makeCurrent() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Remembers which context is current on this thread and makes it current again when it goes;
/// where none was, the one that is current then stays.
class CurrentContextKeeper {
 public:
  CurrentContextKeeper();
  ~CurrentContextKeeper();
  CurrentContextKeeper(const CurrentContextKeeper&) = delete;
  CurrentContextKeeper& operator=(const CurrentContextKeeper&) = delete;

 private:
  // EGLDisplay, EGLContext and the EGLSurfaces to draw to and to read from.
  void* display_;
  void* context_;
  void* draw_;
  void* read_;
};

/// An error (kUnsupported) that names the device's limit where a texture of this size exceeds it.
hal::Result<void> checkDeviceLimit(const ContextInfo& context, hal::FrameSize size,
                                   std::string_view what);

/// Describes the context that is current on this thread; throws hal::Failure if there is none
/// or if it is older than OpenGL ES 3.1.
ContextInfo inspectCurrentContext(std::string platform);

}  // namespace pleinair::gpu
