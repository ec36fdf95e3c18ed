// A GPU that is lost for as long as a file exists, whatever context is asked: preloaded into a program (LD_PRELOAD), it answers
// for the driver how a context was reset. The file: /run/lost-gpu.
#include <cstring>

#include <dlfcn.h>
#include <unistd.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>

namespace {

constexpr unsigned kGuilty = 0x8253;  // GL_GUILTY_CONTEXT_RESET

unsigned resetStatus() { return access("/run/lost-gpu", F_OK) == 0 ? kGuilty : 0; }

}  // namespace

extern "C" __attribute__((visibility("default"))) __eglMustCastToProperFunctionPointerType
eglGetProcAddress(const char* name) {
  if (std::strncmp(name, "glGetGraphicsResetStatus", std::strlen("glGetGraphicsResetStatus")) == 0) {
    return reinterpret_cast<__eglMustCastToProperFunctionPointerType>(resetStatus);
  }
  static const auto next =
      reinterpret_cast<decltype(&eglGetProcAddress)>(dlsym(RTLD_NEXT, "eglGetProcAddress"));
  return next(name);
}
