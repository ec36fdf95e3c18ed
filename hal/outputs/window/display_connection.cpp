#include "hal/outputs/window/display_connection.h"

#include <atomic>

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

}  // namespace pleinair::hal::window::display_connection
