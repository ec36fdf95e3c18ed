#include "hal/outputs/window/sdl_video.h"

#include <atomic>
#include <cassert>
#include <cstdlib>
#include <string>
#include <thread>
#include <utility>

#include <SDL_syswm.h>
#include <dlfcn.h>
#include <poll.h>

namespace pleinair::hal::window::display_connection {
namespace {

std::atomic<bool> lost = false;  // Xlib may find out on a thread of Mesa's
int connection = -1;

#ifdef SDL_VIDEO_DRIVER_X11
using ErrorHandler = int (*)(Display*);
using ExitHandler = void (*)(Display*, void*);

int onError(Display*) {
  lost = true;
  return 0;
}
void onExit(Display*, void*) {}

/// A function of the Xlib that SDL has loaded; null if that library lacks it.
template <class Function>
Function xlib(const char* name) {
  static void* const library = dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
  return library == nullptr ? nullptr : reinterpret_cast<Function>(dlsym(library, name));
}
#endif

}  // namespace

void watch(SDL_Window* window) {
#ifdef SDL_VIDEO_DRIVER_X11
  SDL_SysWMinfo info;
  SDL_VERSION(&info.version);
  if (SDL_GetWindowWMInfo(window, &info) != SDL_TRUE || info.subsystem != SDL_SYSWM_X11) return;
  Display* const display = info.info.x11.display;
  if (const auto number = xlib<int (*)(Display*)>("XConnectionNumber")) {
    connection = number(display);
  }
  // Xlib exits once the first returns, unless the second is set (libX11 1.7 and later).
  if (const auto set = xlib<ErrorHandler (*)(ErrorHandler)>("XSetIOErrorHandler")) set(onError);
  const auto setExit = xlib<void (*)(Display*, ExitHandler, void*)>("XSetIOErrorExitHandler");
  if (setExit != nullptr) setExit(display, onExit, nullptr);
#else
  static_cast<void>(window);
#endif
}

void forget() {
  connection = -1;
}

bool isLost() {
  if (lost || connection < 0) return lost;
  pollfd socket{.fd = connection, .events = 0, .revents = 0};
  if (poll(&socket, 1, 0) > 0) lost = true;  // without events, only a hang-up or an error is told
  return lost;
}

bool hasWindowManager(SDL_Window* window) {
#ifdef SDL_VIDEO_DRIVER_X11
  SDL_SysWMinfo info;
  SDL_VERSION(&info.version);
  if (SDL_GetWindowWMInfo(window, &info) != SDL_TRUE || info.subsystem != SDL_SYSWM_X11)
    return true;
  Display* const display = info.info.x11.display;
  using Property = int (*)(Display*, ::Window, Atom, long, long, Bool, Atom, Atom*, int*,
                           unsigned long*, unsigned long*, unsigned char**);
  const auto atomOf = xlib<Atom (*)(Display*, const char*, Bool)>("XInternAtom");
  const auto rootOf = xlib<::Window (*)(Display*)>("XDefaultRootWindow");
  const auto propertyOf = xlib<Property>("XGetWindowProperty");
  const auto release = xlib<int (*)(void*)>("XFree");
  if (atomOf == nullptr || rootOf == nullptr || propertyOf == nullptr || release == nullptr) {
    return true;
  }
  // Every window manager of the last twenty years sets it (EWMH 1.3, "Root Window Properties").
  const Atom atom = atomOf(display, "_NET_SUPPORTING_WM_CHECK", True);
  if (atom == None) return false;
  Atom type = None;
  int bits = 0;
  unsigned long count = 0;
  unsigned long left = 0;
  unsigned char* value = nullptr;
  constexpr Atom kAnyType = 0;
  const int status = propertyOf(display, rootOf(display), atom, 0, 1, False, kAnyType, &type, &bits,
                                &count, &left, &value);
  if (value != nullptr) release(value);
  return status == Success && count > 0;
#else
  static_cast<void>(window);
  return true;
#endif
}

}  // namespace pleinair::hal::window::display_connection

namespace pleinair::hal::window {
namespace {

// Looked at by the thread that SDL belongs to only, but for the assertion that it is that one.
int users = 0;
std::thread::id thread;

bool isSet(const char* variable) {
  const char* value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nothing sets any
  return value != nullptr && *value != '\0';
}

/// The display servers that the environment names. SDL, left alone, goes on to windows that nobody
/// sees. SDL_VIDEODRIVER overrides this.
std::string namedDrivers() {
  std::string drivers = isSet("DISPLAY") ? "x11" : "";
  if (isSet("WAYLAND_DISPLAY")) drivers += drivers.empty() ? "wayland" : ",wayland";
  return drivers;
}

Error noDisplay(const std::string& cause) {
  return {.kind = ErrorKind::kNotFound,
          .subject = "window",
          .problem = "there is no display to open it on: " + cause,
          .remedy = "start it on a desktop, or write to a file with --output FILE"};
}

}  // namespace

Result<SdlVideo> SdlVideo::open() {
  assert(users == 0 || isOnItsThread());
  if (display_connection::isLost()) {
    return tl::unexpected(Error{.kind = ErrorKind::kDeviceLost,
                                .subject = "window",
                                .problem = "the display server is gone",
                                .remedy = "start the program again"});
  }
  const std::string drivers = namedDrivers();
  if (drivers.empty() && !isSet("SDL_VIDEODRIVER")) {
    return tl::unexpected(noDisplay("DISPLAY and WAYLAND_DISPLAY are not set"));
  }
  SDL_SetHint(SDL_HINT_VIDEODRIVER, drivers.c_str());
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");  // SIGINT and SIGTERM are the program's
  SDL_SetHint(SDL_HINT_VIDEO_X11_NET_WM_BYPASS_COMPOSITOR, "0");
  SDL_SetHint(SDL_HINT_OPENGL_ES_DRIVER, "1");  // EGL, as the painter has it, not GLX
  if (SDL_InitSubSystem(SDL_INIT_VIDEO) != 0) return tl::unexpected(noDisplay(SDL_GetError()));
  thread = std::this_thread::get_id();
  ++users;
  return SdlVideo();
}

SdlVideo::SdlVideo(SdlVideo&& other) noexcept : isOpen_(std::exchange(other.isOpen_, false)) {}

SdlVideo::~SdlVideo() {
  if (!isOpen_) return;
  assert(isOnItsThread());
  --users;
  if (display_connection::isLost()) return;
  if (users == 0) display_connection::forget();
  SDL_QuitSubSystem(SDL_INIT_VIDEO);
}

bool SdlVideo::isOnItsThread() {
  return thread == std::this_thread::get_id();
}

}  // namespace pleinair::hal::window
