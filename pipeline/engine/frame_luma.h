#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "hal/captured_frame.h"
#include "hal/clock.h"
#include "pipeline/engine/camera_path.h"
#include "pipeline/gpu/frames/camera_frames.h"
#include "pipeline/gpu/gpu_loss.h"
#include "pipeline/gpu/images/luma_readback.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/tracking/image/luma.h"

namespace pleinair {

/// How long the GPU is waited for.
struct LumaLimits {
  hal::Duration trial = std::chrono::milliseconds(50);
  /// Once its way is taken: a frame's luma that is later is copied instead.
  hal::Duration frame = std::chrono::milliseconds(10);
};

/// Brings the luma of frames to the trackers: from a second stream where the camera makes one and
/// nothing needs whole frames; in place from ordinary memory; and from memory that a device shares,
/// which may be slow to read, by a copy or by the GPU, where that reads the frame anyway.
///
/// Which of the two is found out for each memory: in its first frames that the GPU imports, both
/// are timed and compared to the bit. The GPU's way has to take half the time at most, because the
/// thread that waits for it gives it no work meanwhile. Whatever way, pixels are the same, but for
/// the second stream's. Paint thread only.
class FrameLuma {
 public:
  /// Frames that are read both ways.
  static constexpr std::size_t kRounds = 9;

  FrameLuma(const gpu::ShaderLibrary& library, const gpu::ContextInfo& context,
            const gpu::GpuTestHook& testHook = {}, const hal::Clock& clock = hal::steadyClock(),
            LumaLimits limits = {});

  /// Takes a frame that `frames` has shown. `needsWhole`: its luma is read at its own size.
  /// Returns the mapping to keep until trackers have read it, if they read the frame's memory.
  [[nodiscard]] std::optional<hal::FrameMapping> take(const hal::CapturedFrame& frame,
                                                      gpu::CameraFrames& frames, bool needsWhole);
  /// Nothing reads this frame's luma.
  void skip();

  /// Of the frame that was taken.
  tracking::LumaFrame& luma() { return luma_; }
  LumaSource source() const { return source_; }
  const std::string& reason() const { return reason_; }

 private:
  /// What is known of the ways out of one memory (BufferIdentity::pool).
  struct Trial {
    std::uint64_t pool = 0;
    hal::FrameFormat format;
    std::size_t rounds = 0;
    std::array<hal::Duration, kRounds> copies{}, readbacks{};
    bool isOver = false;
    bool readsBack = false;
    int late = 0;  ///< frames in a row
    std::string verdict;
  };

  void came(LumaSource source, const std::string& reason);
  void copy(const hal::CapturedFrame& frame);
  void takeShared(const hal::CapturedFrame& frame, gpu::CameraFrames& frames);
  void followTrial(const hal::CapturedFrame& frame, gpu::CameraFrames& frames);
  bool readBack(const hal::CapturedFrame& frame, gpu::CameraFrames& frames, hal::Duration limit);
  void decide();
  void refuse(std::string verdict);

  std::optional<gpu::LumaReadback> readback_;  ///< where the GPU may import frames
  const hal::Clock& clock_;
  LumaLimits limits_;
  tracking::LumaFrame luma_;
  hal::Image read_;  ///< what the GPU gave
  Trial trial_;
  hal::FrameSize streamSize_;  ///< of second images, as reason_ has it
  LumaSource source_ = LumaSource::kNone;
  std::string reason_;
};

}  // namespace pleinair
