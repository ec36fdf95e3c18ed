#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "hal/camera.h"
#include "hal/cameras/synthetic/camera_path.h"
#include "hal/cameras/synthetic/frame_pool.h"
#include "hal/cameras/synthetic/ground_truth.h"
#include "hal/cameras/synthetic/renderer.h"
#include "hal/cameras/synthetic/sensor.h"
#include "hal/pacing.h"

namespace pleinair::hal {

struct SyntheticOptions {
  FrameSize size{640, 480};
  Duration framePeriod{33'333'333};
  std::optional<std::uint64_t> frameCount;  ///< unset: goes on for ever
  std::uint32_t seed = 1;                   ///< of the wood, the camera's path and the noise
  double noiseSigma = 2.0;                  ///< of each channel, in 8-bit levels
  Pacing pacing = Pacing::kStepped;
};

/// A simulated camera, held by hand over a painter's desk with AprilTags on it (deskTags()), of
/// which the truth is known. RGB8, without distortion. Everything is a function of the options and
/// the frame's sequence number, whichever frames were asked for before; the same on every run.
///
/// captureTime is the clock's time at start() plus sequence × framePeriod; exact. Stepped, every
/// frame comes at once; in real time, each at its capture time, and frames for which the consumer
/// or the computer was too slow are left out and counted in droppedBefore. StreamRequest is not
/// looked at: the options decide.
///
/// start() paints the desk, which takes about a second and 75 MB; the cameras of a process with the
/// same seed share it. The clock must outlive the camera. truth() and the flows need no start() and
/// may be called from any thread.
class SyntheticCamera final : public Camera {
 public:
  SyntheticCamera(SyntheticOptions options, Clock& clock);

  CameraIdentity identity() const override;
  /// Errors: kUnsupported (size beyond the limits), kInvalidArgument (frame period or noise).
  Result<StreamFormat> start(const StreamRequest& request) override;
  NextFrame next(TimePoint deadline) override;
  void stop() override;

  GroundTruth truth(std::uint64_t sequence) const;
  /// How what is seen at `pixel` of frame `from` moves to frame `to`.
  FlowVector flow(std::uint64_t from, std::uint64_t to, glm::dvec2 pixel) const;
  FlowField flowField(std::uint64_t from, std::uint64_t to) const;

 private:
  synthetic::CameraView viewOf(std::uint64_t sequence) const;
  TimePoint captureTimeOf(std::uint64_t sequence) const;
  /// The next frame in turn, or a later one where its time has passed.
  std::uint64_t dueSequence() const;
  CapturedFrame capture(std::uint64_t sequence);

  SyntheticOptions options_;
  Clock& clock_;
  synthetic::HandheldPath path_;
  synthetic::Sensor sensor_;
  synthetic::FramePool pool_;
  std::shared_ptr<const synthetic::Renderer> renderer_;

  TimePoint startTime_;
  std::uint64_t nextSequence_ = 0;
  std::optional<CapturedFrame> pending_;
};

}  // namespace pleinair::hal
