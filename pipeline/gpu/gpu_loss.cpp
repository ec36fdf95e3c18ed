#include "pipeline/gpu/gpu_loss.h"

#include <string_view>
#include <utility>

#include <EGL/egl.h>

#include "pipeline/gpu/gl.h"

namespace pleinair::gpu {
namespace {

/// The driver's function: of OpenGL ES 3.2, or of the extension that this context has.
PFNGLGETGRAPHICSRESETSTATUSKHRPROC resetStatusFunction() {
  const auto find = [](const char* name) {
    return reinterpret_cast<PFNGLGETGRAPHICSRESETSTATUSKHRPROC>(eglGetProcAddress(name));
  };
  GLint major = 0;
  GLint minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  if (major * 10 + minor >= 32) return find("glGetGraphicsResetStatus");
  GLint count = 0;
  glGetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    const std::string_view name(reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, i)));
    if (name == "GL_KHR_robustness") return find("glGetGraphicsResetStatusKHR");
    if (name == "GL_EXT_robustness") return find("glGetGraphicsResetStatusEXT");
  }
  return nullptr;
}

std::string problemOf(unsigned status) {
  switch (status) {
    case GL_GUILTY_CONTEXT_RESET_KHR:
      return "was reset: a fault or a hang in what we painted";
    case GL_INNOCENT_CONTEXT_RESET_KHR:
      return "was reset: a fault or a hang in another program";
    default:
      return "was reset, for an unknown reason";
  }
}

}  // namespace

hal::Error gpuLost(std::string problem, int glCode) {
  return {.kind = hal::ErrorKind::kDeviceLost,
          .subject = "GPU",
          .problem = std::move(problem),
          .remedy = "see the kernel's log; start again",
          .domain = hal::ErrorDomain::kGl,
          .code = glCode};
}

ResetMonitor::ResetMonitor(GpuTestHook testHook) : testHook_(std::move(testHook)) {
  if (!testHook_.resetStatus) {
    if (const auto ask = resetStatusFunction(); ask != nullptr) testHook_.resetStatus = ask;
  }
}

hal::Result<void> ResetMonitor::check() {
  if (!loss_ && testHook_.resetStatus) {
    const unsigned status = testHook_.resetStatus();
    if (status != GL_NO_ERROR) note(gpuLost(problemOf(status), static_cast<int>(status)));
  }
  if (loss_) return tl::unexpected(*loss_);
  return {};
}

void ResetMonitor::note(const hal::Error& loss) {
  if (!loss_) loss_ = loss;
}

bool tellsOfResets() {
  if (resetStatusFunction() == nullptr) return false;
  GLint strategy = 0;
  glGetIntegerv(GL_RESET_NOTIFICATION_STRATEGY_KHR, &strategy);
  return strategy == GL_LOSE_CONTEXT_ON_RESET_KHR;
}

}  // namespace pleinair::gpu
