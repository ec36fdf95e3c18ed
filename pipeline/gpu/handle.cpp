#include "pipeline/gpu/handle.h"

#include <chrono>

#include <fmt/format.h>

namespace pleinair::gpu {
namespace {

thread_local int abandonsObjects = 0;

hal::Error waitFailed() {
  return gpuLost("cannot wait for it: it or its context is lost", GL_WAIT_FAILED);
}

}  // namespace

ContextLossGuard::ContextLossGuard() {
  ++abandonsObjects;
}

ContextLossGuard::~ContextLossGuard() {
  --abandonsObjects;
}

bool ContextLossGuard::isInForce() {
  return abandonsObjects > 0;
}

FenceState Fence::state(GLuint64 timeoutNs, const GpuTestHook& testHook) const {
  if (sync_ == nullptr) return FenceState::kFailed;
  assert(eglGetCurrentContext() == context_);
  switch (testHook.waitForFence ? testHook.waitForFence(timeoutNs)
                                : glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, timeoutNs)) {
    case GL_ALREADY_SIGNALED:
    case GL_CONDITION_SATISFIED:
      return FenceState::kSignalled;
    case GL_TIMEOUT_EXPIRED:
      return FenceState::kNotYet;
    default:
      return FenceState::kFailed;
  }
}

hal::Answer Fence::passed(const GpuTestHook& testHook, hal::Duration limit) const {
  const FenceState now = state(static_cast<GLuint64>(limit.count()), testHook);
  if (now != FenceState::kFailed) return now == FenceState::kSignalled;
  return tl::unexpected(waitFailed());
}

hal::Result<void> Fence::wait(const GpuTestHook& testHook) const {
  const hal::SteadyClock steady;
  const hal::Clock& clock = testHook.clock != nullptr ? *testHook.clock : steady;
  const hal::TimePoint deadline = clock.now() + testHook.patience;
  for (hal::Duration left = testHook.patience;
       left > hal::Duration::zero();  // drivers may cap waits
       left = deadline - clock.now()) {
    const FenceState now = state(static_cast<GLuint64>(left.count()), testHook);
    if (now == FenceState::kSignalled) return {};
    if (now == FenceState::kFailed) return tl::unexpected(waitFailed());
  }
  const double seconds = std::chrono::duration<double>(testHook.patience).count();
  return tl::unexpected(
      gpuLost(fmt::format("hangs: no answer for {:.0f} s", seconds), GL_TIMEOUT_EXPIRED));
}

}  // namespace pleinair::gpu
