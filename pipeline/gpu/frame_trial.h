#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/captured_frame.h"
#include "hal/clock.h"
#include "hal/error.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/gpu/trial_process.h"

namespace pleinair::gpu {

/// Imports a camera's frame in another process, draws it there and compares it with the
/// processor's view, because software drivers have crashed in memory that they imported without an
/// error (Mesa 22.3: what vivid exports, through vgem). That process is this program, started with
/// arguments of its own; its main() has runFrameTrial(). Never waits; one thread.
class FrameTrial {
 public:
  /// Starts it. The frame's lease is held until it has ended. Precondition: all planes have
  /// dma-bufs.
  explicit FrameTrial(const hal::CapturedFrame& frame,
                      const hal::Clock& clock = hal::steadyClock());

  /// Nothing while it runs. Error: kUnsupported (it has crashed, failed, takes too long, or saw
  /// other pixels).
  std::optional<hal::Result<void>> poll();

 private:
  TrialProcess process_;
};

/// Carries out a trial, if the arguments of main() are those of one, and gives the exit status.
std::optional<int> runFrameTrial(int argc, const char* const* argv);

/// The pixels of an RGBA8 texture. Waits for the GPU.
std::vector<std::uint8_t> pixelsOf(const Texture& texture);
/// How what the GPU has read of a camera's memory differs from what the processor has.
std::string differenceText(std::span<const std::uint8_t> seen, std::span<const std::uint8_t> right);

}  // namespace pleinair::gpu
