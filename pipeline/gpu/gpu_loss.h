#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/surface.h"

namespace pleinair::gpu {

/// The calls by which a lost GPU is noticed, and by which it shares memory. Empty functions stand
/// for the driver's own; tests replace them.
struct GpuTestHook {
  std::function<unsigned()> resetStatus;  ///< glGetGraphicsResetStatus()
  /// glClientWaitSync() with this timeout, ns
  std::function<unsigned(std::uint64_t timeoutNs)> waitForFence;
  /// The name of a texture that shares a surface's memory; 0: refused
  std::function<unsigned(const hal::GpuSurface&)> importSurface;
  /// The same for a plane of a camera's buffer, whose index the surface's id is
  std::function<unsigned(const hal::GpuSurface&)> importPlane;
  /// Cameras get their buffers back while the GPU may still read them: a control.
  bool returnsFramesEarly = false;
  /// A GPU that does not finish its work within this time is taken for lost.
  hal::Duration patience = std::chrono::seconds(2);
  const hal::Clock* clock = nullptr;  ///< of the patience; CLOCK_MONOTONIC
};

/// The error (kDeviceLost) of a GPU that is gone.
hal::Error gpuLost(std::string problem, int glCode);

/// Notices that the current context's GPU was reset, and remembers it. On the context's thread.
class ResetMonitor {
 public:
  /// Monitors the current context. If its driver cannot be asked, the GPU counts as healthy until a
  /// call fails.
  explicit ResetMonitor(GpuTestHook testHook = {});

  /// Asks the driver unless the GPU is known to be lost.
  hal::Result<void> check();
  /// Remembers a loss that was met elsewhere.
  void note(const hal::Error& loss);
  /// The loss, once there was one. Any thread that does not run beside the above.
  const std::optional<hal::Error>& loss() const { return loss_; }

 private:
  GpuTestHook testHook_;
  std::optional<hal::Error> loss_;
};

/// Whether the current context reports its resets.
bool tellsOfResets();

}  // namespace pleinair::gpu
