#pragma once

#include <cstdint>
#include <optional>

#include "hal/camera.h"
#include "hal/cameras/synthetic/ground_truth.h"
#include "hal/cameras/synthetic/render/exposure.h"
#include "hal/cameras/synthetic/render/motion.h"
#include "hal/cameras/synthetic/render/renderer.h"
#include "hal/cameras/synthetic/render/sensor.h"
#include "hal/cameras/synthetic/render/shot.h"
#include "hal/clock.h"
#include "hal/frame_pool.h"

namespace pleinair::hal {

struct SyntheticOptions {
  FrameSize size{640, 480};
  Duration framePeriod{33'333'333};
  std::optional<std::uint64_t> frameCount;  ///< unset: goes on for ever
  SyntheticShot shot = SyntheticShot::kWalkaround;
  std::uint32_t seed = 1;         ///< of the wood, the hand that holds the camera, and the noise
  double noiseSigma = 2.0;        ///< of each channel, in 8-bit levels; 0 … 40
  double exposureDriftStops = 0;  ///< brightness wanders within ± this many stops; 0 … 2
  double whiteBalanceDrift =
      0;                ///< red and blue wander against each other by ± this share; 0 … 0.5
  Duration rowTime{0};  ///< between rows; 0: global shutter. All rows within a frame period
  Pacing pacing = Pacing::kStepped;
};

/// A simulated camera before a workbench by a window, with AprilTags (benchTags()), of which the
/// truth is known. RGB8, without distortion. Everything is a function of the options and the
/// frame's sequence number, whichever frames were asked for before; the same on every run.
///
/// captureTime is the clock's time at start() plus sequence × framePeriod; exact, and row 0's.
/// Stepped, every frame comes at once; in real time, each at its capture time, and frames for which
/// the consumer or the computer was too slow are left out and counted in droppedBefore.
/// StreamRequest is not looked at: the options decide.
///
/// start() paints the workbench, which takes about a second and 100 MB at most, for kLights twice
/// as much; the cameras of a process with the same seed share it. The clock must outlive the
/// camera. truth(), the flows and the masks need no start() and may be called from any thread.
class SyntheticCamera final : public Camera {
 public:
  SyntheticCamera(SyntheticOptions options, Clock& clock);

  CameraIdentity identity() const override;
  /// Errors: kUnsupported (size beyond the limits), kInvalidArgument (another option out of range).
  Result<StreamFormat> start(const StreamRequest& request) override;
  NextFrame next(TimePoint deadline) override;
  void stop() override;

  GroundTruth truth(std::uint64_t sequence) const;
  /// Rigid, to OpenCV's camera frame, when row `row` was exposed; the same for all rows of a global
  /// shutter.
  glm::dmat4 cameraFromWorld(std::uint64_t sequence, int row) const;
  /// How what is seen at `pixel` of frame `from` moves to frame `to`.
  FlowVector flow(std::uint64_t from, std::uint64_t to, glm::dvec2 pixel) const;
  /// At every pixel centre, or at every n-th pixel's of every n-th row.
  FlowField flowField(std::uint64_t from, std::uint64_t to, int everyNth = 1) const;
  /// Where frame `sequence` shows the arm or a figure: at every pixel centre, or at every n-th
  /// pixel's of every n-th row.
  MovingMask movingMask(std::uint64_t sequence, int everyNth = 1) const;

 private:
  synthetic::Exposure exposureOf(std::uint64_t sequence) const;
  synthetic::SensorGains gainsOf(std::uint64_t sequence) const;
  TimePoint captureTimeOf(std::uint64_t sequence) const;
  /// The next frame in turn, or a later one where its time has passed.
  std::uint64_t dueSequence() const;
  CapturedFrame capture(std::uint64_t sequence);

  SyntheticOptions options_;
  Clock& clock_;
  synthetic::Motion motion_;
  synthetic::SmoothNoise brightness_, balance_;
  synthetic::Sensor sensor_;
  FramePool pool_;
  std::optional<synthetic::Renderer> renderer_;
  std::optional<synthetic::Renderer> spotlitRenderer_;  ///< of kLights, while the spotlight is on

  TimePoint startTime_;
  std::uint64_t nextSequence_ = 0;
  std::optional<CapturedFrame> pending_;
};

}  // namespace pleinair::hal
