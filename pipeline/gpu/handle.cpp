#include "pipeline/gpu/handle.h"

#include "hal/error.h"

namespace pleinair::gpu {

FenceState Fence::state(GLuint64 timeoutNs) const {
  if (sync_ == nullptr) return FenceState::kFailed;
  assert(eglGetCurrentContext() == context_);
  switch (glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, timeoutNs)) {
    case GL_ALREADY_SIGNALED:
    case GL_CONDITION_SATISFIED:
      return FenceState::kSignalled;
    case GL_TIMEOUT_EXPIRED:
      return FenceState::kNotYet;
    default:
      return FenceState::kFailed;
  }
}

bool Fence::passed(GLuint64 timeoutNs) const {
  const FenceState now = state(timeoutNs);
  if (now == FenceState::kFailed) {
    throw hal::StartupError(hal::Error{.kind = hal::ErrorKind::kDeviceLost,
                                       .subject = "GPU",
                                       .problem = "cannot wait for it: it or its context is lost",
                                       .remedy = "see the kernel's log; start again",
                                       .domain = hal::ErrorDomain::kGl,
                                       .code = GL_WAIT_FAILED});
  }
  return now == FenceState::kSignalled;
}

void Fence::wait() const {
  constexpr GLuint64 kOnceNs = 1'000'000'000;  // drivers may cap longer waits
  while (!passed(kOnceNs)) {
  }
}

}  // namespace pleinair::gpu
