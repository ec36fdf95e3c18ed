#include "pipeline/gpu/context/egl_context.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <gbm.h>
#include <sys/resource.h>
#include <unistd.h>

#include "hal/error.h"
#include "hal/file_descriptor.h"
#include "pipeline/gpu/context/shared_displays.h"
#include "pipeline/gpu/gl.h"
#include "pipeline/gpu/gpu_loss.h"

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

struct GbmDeviceDeleter {
  void operator()(gbm_device* device) const { gbm_device_destroy(device); }
};

/// An open render node with its GBM device.
struct GbmNode {
  hal::FileDescriptor node;
  std::unique_ptr<gbm_device, GbmDeviceDeleter> device;

  GbmNode() = default;
  explicit GbmNode(const std::string& path) : node(open(path.c_str(), O_RDWR | O_CLOEXEC)) {
    if (node) device.reset(gbm_create_device(node.get()));
  }
};

std::string glString(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text == nullptr ? std::string{} : reinterpret_cast<const char*>(text);
}

#if !defined(NDEBUG)
void GL_APIENTRY onDebugMessage(GLenum source, GLenum type, GLuint id, GLenum /*severity*/,
                                GLsizei /*length*/, const GLchar* message, const void* /*user*/) {
  // A shader that does not compile is the world's failure (live editing): ShaderLibrary throws. So
  // is a lack of memory: checkMemory() throws.
  if (type != GL_DEBUG_TYPE_ERROR_KHR || source == GL_DEBUG_SOURCE_SHADER_COMPILER_KHR) return;
  // A lost context: ResetMonitor.
  if (id == GL_CONTEXT_LOST_KHR || std::strstr(message, "GL_CONTEXT_LOST") != nullptr) return;
  if (id == GL_OUT_OF_MEMORY || std::strstr(message, "GL_OUT_OF_MEMORY") != nullptr) return;
  std::fputs("pleinair: GL error, a broken contract of our own: ", stderr);
  std::fputs(message, stderr);
  std::fputc('\n', stderr);
  std::abort();
}

void abortOnGlErrors() {
  const auto callback = eglFunction<PFNGLDEBUGMESSAGECALLBACKKHRPROC>("glDebugMessageCallbackKHR");
  if (callback == nullptr || !hasWord(glString(GL_EXTENSIONS).c_str(), "GL_KHR_debug")) return;
  glEnable(GL_DEBUG_OUTPUT_KHR);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS_KHR);
  callback(onDebugMessage, nullptr);
}
#else
void abortOnGlErrors() {}
#endif

/// The least of the limits that a picture meets on its way.
int maxSidePixels() {
  GLint texture = 0;
  std::array<GLint, 2> viewport{};
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
  return std::min({texture, viewport[0], viewport[1]});
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
    throw hal::Failure(Error{.kind = ErrorKind::kUnsupported,
                             .subject = "GPU",
                             .problem = info.version.empty()
                                            ? "no context is current on this thread"
                                            : fmt::format("the context is \"{}\"", info.version),
                             .remedy = "make a context of OpenGL ES 3.1 or later current"});
  }
  info.isSoftware = info.renderer.find("llvmpipe") != std::string::npos ||
                    info.renderer.find("softpipe") != std::string::npos;
  const std::string extensions = glString(GL_EXTENSIONS);
  info.maxSidePixels = maxSidePixels();
  info.tellsOfResets = tellsOfResets();
  info.hasTimerQuery = hasWord(extensions.c_str(), "GL_EXT_disjoint_timer_query");
  return info;
}

hal::Result<void> checkDeviceLimit(const ContextInfo& context, hal::FrameSize size,
                                   std::string_view what) {
  if (size.width <= context.maxSidePixels && size.height <= context.maxSidePixels) return {};
  return tl::unexpected(Error{
      .kind = ErrorKind::kUnsupported,
      .subject = std::string(what),
      .problem =
          fmt::format("{}x{} is beyond this GPU ({})", size.width, size.height, context.renderer),
      .remedy = fmt::format("it takes at most {} px a side", context.maxSidePixels),
      .domain = ErrorDomain::kGl});
}

namespace {

/// The shared displays that contexts were made on, which stay initialised.
class SharedDisplays {
 public:
  static SharedDisplays& instance() {
    static SharedDisplays displays;
    return displays;
  }
  void add(EGLDisplay display) {
    const std::scoped_lock lock(mutex_);
    if (std::ranges::find(displays_, display) == displays_.end()) displays_.push_back(display);
  }
  void terminate() {
    const std::scoped_lock lock(mutex_);
    for (EGLDisplay display : displays_) eglTerminate(display);
    displays_.clear();
  }

 private:
  std::mutex mutex_;
  std::vector<EGLDisplay> displays_;
};

/// The next step where no context can be made.
std::string contextRemedy() {
  rlimit memory{};
  if (getrlimit(RLIMIT_AS, &memory) == 0 && memory.rlim_cur != RLIM_INFINITY) {
    return fmt::format(
        "this process may use {} MiB of address space (ulimit -v), which a driver takes more than: "
        "raise that limit first",
        memory.rlim_cur / (1024 * 1024));
  }
  return "install Mesa's EGL (libegl1, libgl1-mesa-dri) or the vendor's driver";
}

/// A context on a display, and what the display was made from.
class OpenContext {
 public:
  OpenContext() = default;
  OpenContext(const OpenContext&) = delete;
  OpenContext& operator=(const OpenContext&) = delete;
  ~OpenContext() {
    if (display_ == EGL_NO_DISPLAY) return;
    if (context_ != EGL_NO_CONTEXT) {
      if (eglGetCurrentContext() == context_) {
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
      }
      eglDestroyContext(display_, context_);
    }
    // A display of our own device dies before the device. Others are shared by every context of
    // the process and stay initialised.
    if (node_.device != nullptr) eglTerminate(display_);
  }

  /// Makes a context current. Returns the step that failed; empty where none did.
  std::string_view open(EGLDisplay display, std::string_view platform) {
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) return "no display";
    if (node_.device == nullptr) SharedDisplays::instance().add(display);
    return openOn(display, platform);
  }

  /// The same on a display that is initialised, and is left so.
  std::string_view openOn(EGLDisplay display, std::string_view platform) {
    display_ = display;
    if (!hasWord(eglQueryString(display_, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context")) {
      return "needs a surface";
    }
    if (!makeContext() || !makeCurrent()) return "no OpenGL ES 3.1";
    info_ = inspectCurrentContext(std::string(platform));
    return {};
  }

  std::string_view openGbm(const std::string& path) {
    node_ = GbmNode(path);
    if (node_.device == nullptr) return "no usable render node";
    return open(eglGetPlatformDisplay(EGL_PLATFORM_GBM_KHR, node_.device.get(), nullptr), "gbm");
  }

  bool makeCurrent() {
    return eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE;
  }
  EGLContext context() const { return context_; }
  const ContextInfo& info() const { return info_; }
  void explain(std::string apartBecause) { info_.apartBecause = std::move(apartBecause); }

 private:
  bool makeContext() {
    eglBindAPI(EGL_OPENGL_ES_API);
    const std::array<EGLint, 5> configAttributes{EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT,
                                                 EGL_SURFACE_TYPE, 0, EGL_NONE};
    EGLConfig config = EGL_NO_CONFIG_KHR;
    EGLint count = 0;
    eglChooseConfig(display_, configAttributes.data(), &config, 1, &count);
    if (count == 0) config = EGL_NO_CONFIG_KHR;
    // A driver may list the one way to be told of resets, or the other, and refuse it all the same.
    for (const EGLint resetNotification : resetNotifications()) {
      // Software's on a card (kms_swrast) refuses a debug context.
      for (const bool isDebug : {kIsDebug, false}) {
        context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT,
                                    contextAttributes(resetNotification, isDebug).data());
        if (context_ != EGL_NO_CONTEXT) return true;
      }
    }
    return false;
  }

  /// The attributes to ask for it with, in the order of trying; EGL_NONE: do without.
  std::vector<EGLint> resetNotifications() const {
    std::vector<EGLint> ways;
    if (hasWord(eglQueryString(display_, EGL_EXTENSIONS), "EGL_EXT_create_context_robustness")) {
      ways.push_back(EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT);
    }
    const char* version = eglQueryString(display_, EGL_VERSION);
    if (version != nullptr && std::string_view(version).starts_with("1.5")) {
      ways.push_back(EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY);
    }
    ways.push_back(EGL_NONE);
    return ways;
  }

#if defined(NDEBUG)
  static constexpr bool kIsDebug = false;
#else
  static constexpr bool kIsDebug = true;
#endif

  static std::vector<EGLint> contextAttributes(EGLint resetNotification, bool isDebug) {
    std::vector<EGLint> attributes{EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 1};
    if (isDebug) attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE});
    if (resetNotification != EGL_NONE) {
      attributes.insert(attributes.end(), {resetNotification, EGL_LOSE_CONTEXT_ON_RESET});
    }
    attributes.push_back(EGL_NONE);
    return attributes;
  }

  GbmNode node_;  // outlives the display made from it
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  ContextInfo info_;
};

/// Whoever sets Mesa's variable wants no hardware looked for.
bool softwareIsWanted() {
  const char* value = std::getenv("LIBGL_ALWAYS_SOFTWARE");  // NOLINT(concurrency-mt-unsafe)
  return value != nullptr && (std::strcmp(value, "1") == 0 || std::strcmp(value, "true") == 0);
}

bool isSoftwareDevice(EGLDeviceEXT device) {
  const auto query = eglFunction<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  return query != nullptr && hasWord(query(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
}

}  // namespace

struct EglContext::Impl {
  std::unique_ptr<OpenContext> chosen;  // software until hardware is found
  std::string attempts;                 // what failed so far, for the one error message

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    assert(chosen == nullptr || eglGetCurrentContext() == chosen->context());  // its own thread
    chosen.reset();
    eglReleaseThread();
  }

  void noteFailure(std::string_view platform, std::string_view step) {
    attempts += fmt::format("{}{}: {} (EGL 0x{:04x})", attempts.empty() ? "" : "; ", platform, step,
                            eglGetError());
  }

  /// Tries one more; true if the search is over. `open` answers as OpenContext::open does.
  template <class Open>
  bool attempt(std::string_view platform, Open open) {
    auto candidate = std::make_unique<OpenContext>();
    if (const std::string_view failure = open(*candidate); !failure.empty()) {
      noteFailure(platform, failure);
      return false;
    }
    const bool isEnough = !candidate->info().isSoftware || softwareIsWanted();
    if (isEnough || chosen == nullptr) chosen = std::move(candidate);
    return isEnough;
  }

  /// On the display of windows. Its software is taken where no hardware is found later.
  bool tryWindows(EGLDisplay display) {
    return attempt("window",
                   [&](OpenContext& context) { return context.openOn(display, "window"); });
  }

  bool trySurfaceless() {
    if (!hasWord(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_MESA_platform_surfaceless")) {
      noteFailure("surfaceless", "not offered");
      return false;
    }
    return attempt("surfaceless", [](OpenContext& context) {
      return context.open(eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr),
                          "surfaceless");
    });
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
      if (chosen != nullptr && isSoftwareDevice(device)) continue;
      if (attempt("device", [device](OpenContext& context) {
            return context.open(eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, device, nullptr),
                                "device");
          })) {
        return true;
      }
    }
    return false;
  }

  bool tryGbm() {
    constexpr int kFirstRenderNode = 128;
    constexpr int kRenderNodes = 8;
    for (int node = kFirstRenderNode; node < kFirstRenderNode + kRenderNodes; ++node) {
      const std::string path = fmt::format("/dev/dri/renderD{}", node);
      if (access(path.c_str(), F_OK) != 0) continue;
      if (attempt(path, [&](OpenContext& context) { return context.openGbm(path); })) return true;
    }
    if (chosen == nullptr) noteFailure("gbm", "no usable render node");
    return false;
  }
};

EglContext::EglContext(void* windows) : impl_(std::make_unique<Impl>()) {
  const bool isOfWindows = windows != nullptr && impl_->tryWindows(windows);
  const std::string ofWindows =
      impl_->chosen == nullptr ? impl_->attempts : impl_->chosen->info().renderer;
  const bool isHardware =
      isOfWindows || impl_->trySurfaceless() || impl_->tryDevices() || impl_->tryGbm();
  const bool isCurrent = impl_->chosen != nullptr && (isHardware || impl_->chosen->makeCurrent());
  if (!isCurrent) {
    impl_->chosen.reset();
    throw hal::Failure(Error{.kind = ErrorKind::kUnsupported,
                             .subject = "GPU",
                             .problem = "no OpenGL ES 3.1 context: " + impl_->attempts,
                             .remedy = contextRemedy(),
                             .domain = ErrorDomain::kEgl});
  }
  if (windows != nullptr && info().platform != "window") {
    impl_->chosen->explain(
        fmt::format("paintings are made by {}, the window by {}", info().renderer, ofWindows));
  }
  abortOnGlErrors();
}

EglContext::~EglContext() = default;

void terminateDisplays() {
  SharedDisplays::instance().terminate();
}

const ContextInfo& EglContext::info() const {
  return impl_->chosen->info();
}

bool EglContext::isCurrent() const {
  return eglGetCurrentContext() == impl_->chosen->context();
}

bool EglContext::makeCurrent() const {
  return isCurrent() || impl_->chosen->makeCurrent();
}

CurrentContextKeeper::CurrentContextKeeper()
    : display_(eglGetCurrentDisplay()),
      context_(eglGetCurrentContext()),
      draw_(eglGetCurrentSurface(EGL_DRAW)),
      read_(eglGetCurrentSurface(EGL_READ)) {}

CurrentContextKeeper::~CurrentContextKeeper() {
  if (context_ == EGL_NO_CONTEXT || eglGetCurrentContext() == context_) return;
  [[maybe_unused]] const bool isBack = eglMakeCurrent(display_, draw_, read_, context_) == EGL_TRUE;
  assert(isBack);
}

}  // namespace pleinair::gpu
