#include "pipeline/gpu/egl_context.h"

#include <array>
#include <cassert>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <gbm.h>
#include <unistd.h>

#include "hal/error.h"
#include "pipeline/gpu/gl.h"

namespace pleinair::gpu {
namespace {

using hal::Error;
using hal::ErrorDomain;
using hal::ErrorKind;

bool hasWord(const char* list, std::string_view word) {
  if (list == nullptr) return false;
  std::string_view rest(list);
  while (!rest.empty()) {
    const std::size_t end = rest.find(' ');
    if (rest.substr(0, end) == word) return true;
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  return false;
}

template <class Function>
Function eglFunction(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

/// An open render node with its GBM device.
struct GbmNode {
  int fd = -1;
  gbm_device* device = nullptr;

  GbmNode() = default;
  explicit GbmNode(const std::string& path) : fd(open(path.c_str(), O_RDWR | O_CLOEXEC)) {
    if (fd >= 0) device = gbm_create_device(fd);
  }
  GbmNode(GbmNode&& other) noexcept
      : fd(std::exchange(other.fd, -1)), device(std::exchange(other.device, nullptr)) {}
  GbmNode& operator=(GbmNode&& other) noexcept {
    std::swap(fd, other.fd);
    std::swap(device, other.device);
    return *this;
  }
  ~GbmNode() {
    if (device != nullptr) gbm_device_destroy(device);
    if (fd >= 0) close(fd);
  }
};

#if !defined(NDEBUG)
void GL_APIENTRY onDebugMessage(GLenum source, GLenum type, GLuint /*id*/, GLenum /*severity*/,
                                GLsizei /*length*/, const GLchar* message, const void* /*user*/) {
  // A shader that does not compile is the world's failure (live editing): ShaderLibrary throws.
  if (type != GL_DEBUG_TYPE_ERROR_KHR || source == GL_DEBUG_SOURCE_SHADER_COMPILER_KHR) return;
  std::fputs("pleinair: GL error, a broken contract of our own: ", stderr);
  std::fputs(message, stderr);
  std::fputc('\n', stderr);
  std::abort();
}

void abortOnGlErrors() {
  const auto callback = eglFunction<PFNGLDEBUGMESSAGECALLBACKKHRPROC>("glDebugMessageCallbackKHR");
  if (callback == nullptr) return;
  glEnable(GL_DEBUG_OUTPUT_KHR);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS_KHR);
  callback(onDebugMessage, nullptr);
}
#else
void abortOnGlErrors() {}
#endif

std::string glString(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text == nullptr ? std::string{} : reinterpret_cast<const char*>(text);
}

}  // namespace

ContextInfo inspectCurrentContext(std::string platform) {
  ContextInfo info{.renderer = glString(GL_RENDERER),
                   .version = glString(GL_VERSION),
                   .platform = std::move(platform)};
  GLint major = 0;
  GLint minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  if (info.version.find("OpenGL ES") == std::string::npos || major * 10 + minor < 31) {
    throw hal::StartupError(
        Error{.kind = ErrorKind::kUnsupported,
              .subject = "GPU",
              .problem = info.version.empty() ? "no context is current on this thread"
                                              : fmt::format("the context is \"{}\"", info.version),
              .remedy = "make a context of OpenGL ES 3.1 or later current"});
  }
  info.isSoftware = info.renderer.find("llvmpipe") != std::string::npos ||
                    info.renderer.find("softpipe") != std::string::npos;
  const std::string extensions = glString(GL_EXTENSIONS);
  info.hasTimerQuery = hasWord(extensions.c_str(), "GL_EXT_disjoint_timer_query");
  return info;
}

struct EglContext::Impl {
  GbmNode gbm;  // outlives the display made from it
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  ContextInfo info;
  std::string attempts;  // what failed so far, for the one error message

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() { closeDisplay(); }

  void closeDisplay() {
    if (display == EGL_NO_DISPLAY) return;
    assert(context == EGL_NO_CONTEXT || eglGetCurrentContext() == context);  // its own thread
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    // The display itself is shared by every context of the process and stays initialised.
    eglReleaseThread();
    context = EGL_NO_CONTEXT;
    display = EGL_NO_DISPLAY;
  }

  void noteFailure(std::string_view platform, std::string_view step) {
    attempts += fmt::format("{}{}: {} (EGL 0x{:04x})", attempts.empty() ? "" : "; ", platform, step,
                            eglGetError());
  }

  bool tryDisplay(EGLDisplay candidate, std::string_view platform) {
    if (candidate == EGL_NO_DISPLAY || !eglInitialize(candidate, nullptr, nullptr)) {
      noteFailure(platform, "no display");
      return false;
    }
    display = candidate;
    if (makeContext(platform)) return true;
    closeDisplay();
    return false;
  }

  bool makeContext(std::string_view platform) {
    const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
    if (!hasWord(extensions, "EGL_KHR_surfaceless_context")) {
      noteFailure(platform, "needs a surface");
      return false;
    }
    eglBindAPI(EGL_OPENGL_ES_API);
    const std::array<EGLint, 5> configAttributes{EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT,
                                                 EGL_SURFACE_TYPE, 0, EGL_NONE};
    EGLConfig config = EGL_NO_CONFIG_KHR;
    EGLint count = 0;
    eglChooseConfig(display, configAttributes.data(), &config, 1, &count);
    if (count == 0) config = EGL_NO_CONFIG_KHR;
    std::array<EGLint, 7> attributes{
        EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 1, EGL_NONE, 0, EGL_NONE};
#if !defined(NDEBUG)
    attributes[4] = EGL_CONTEXT_OPENGL_DEBUG;
    attributes[5] = EGL_TRUE;
#endif
    context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
    if (context == EGL_NO_CONTEXT ||
        !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
      noteFailure(platform, "no OpenGL ES 3.1");
      return false;
    }
    info = inspectCurrentContext(std::string(platform));
    abortOnGlErrors();
    return true;
  }

  bool trySurfaceless() {
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!hasWord(client, "EGL_MESA_platform_surfaceless")) {
      noteFailure("surfaceless", "not offered");
      return false;
    }
    return tryDisplay(eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr),
                      "surfaceless");
  }

  bool tryDevices() {
    const auto query = eglFunction<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    if (query == nullptr || !query(static_cast<EGLint>(devices.size()), devices.data(), &count) ||
        count == 0) {
      noteFailure("device", "none");
      return false;
    }
    for (EGLint i = 0; i < count; ++i) {
      EGLDeviceEXT device = devices[static_cast<std::size_t>(i)];
      if (tryDisplay(eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, device, nullptr), "device")) {
        return true;
      }
    }
    return false;
  }

  bool tryGbm() {
    constexpr int kFirstRenderNode = 128;
    constexpr int kRenderNodes = 8;
    for (int node = kFirstRenderNode; node < kFirstRenderNode + kRenderNodes; ++node) {
      gbm = GbmNode(fmt::format("/dev/dri/renderD{}", node));
      if (gbm.device != nullptr &&
          tryDisplay(eglGetPlatformDisplay(EGL_PLATFORM_GBM_KHR, gbm.device, nullptr), "gbm")) {
        return true;
      }
    }
    noteFailure("gbm", "no usable render node");
    return false;
  }
};

EglContext::EglContext() : impl_(std::make_unique<Impl>()) {
  if (impl_->trySurfaceless() || impl_->tryDevices() || impl_->tryGbm()) return;
  throw hal::StartupError(Error{.kind = ErrorKind::kUnsupported,
                                .subject = "GPU",
                                .problem = "no OpenGL ES 3.1 context: " + impl_->attempts,
                                .remedy = "install Mesa's EGL (libegl1, libgl1-mesa-dri) or the "
                                          "vendor's driver",
                                .domain = ErrorDomain::kEgl});
}

EglContext::~EglContext() = default;

const ContextInfo& EglContext::info() const {
  return impl_->info;
}

}  // namespace pleinair::gpu
