#include "hal/cameras/synthetic/synthetic_camera.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "hal/cameras/synthetic/render/light_changes.h"
#include "hal/cameras/synthetic/world/noise.h"
#include "hal/cameras/synthetic/world/world.h"
#include "hal/paced_frame.h"

namespace pleinair::hal {
namespace {

using synthetic::Exposure;

FrameFormat formatOf(FrameSize size) {
  // The pool wants a size within the limits; start() refuses the others.
  return {.pixelFormat = PixelFormat::kRgb8, .size = isAcceptedSize(size) ? size : FrameSize{1, 1}};
}

/// Half a pixel's footprint or so, as far as memory allows.
double texelMetresFor(FrameSize size) {
  constexpr double kViewingMetres = 1.0;
  constexpr double kFinest = 0.0006;
  constexpr double kCoarsest = 0.004;
  return std::clamp(0.45 * kViewingMetres / syntheticIntrinsics(size).fx, kFinest, kCoarsest);
}

Error refused(ErrorKind kind, std::string problem, std::string remedy) {
  return {.kind = kind,
          .subject = "synthetic camera",
          .problem = std::move(problem),
          .remedy = std::move(remedy)};
}

/// The error of the options; unset if they are valid.
std::optional<Error> problemOf(const SyntheticOptions& options) {
  const auto outside = [](double value, double most) { return !(value >= 0 && value <= most); };
  const auto invalid = [](std::string problem, std::string remedy) {
    return refused(ErrorKind::kInvalidArgument, std::move(problem), std::move(remedy));
  };
  const FrameSize size = options.size;
  if (!isAcceptedSize(size)) {
    return refused(
        ErrorKind::kUnsupported,
        "cannot make frames of " + std::to_string(size.width) + "x" + std::to_string(size.height),
        "choose sides of 1 to " + std::to_string(kMaxSidePixels) + " pixels");
  }
  if (options.framePeriod <= Duration::zero()) {
    return invalid("the frame period is not positive", "choose one such as 33 ms");
  }
  if (outside(options.noiseSigma, synthetic::Sensor::kMaxNoise)) {
    return invalid("the noise is out of range",
                   "choose a standard deviation of 0 to 40 8-bit levels, such as 2");
  }
  if (outside(options.exposureDriftStops, 2)) {
    return invalid("the exposure's drift is out of range", "choose 0 to 2 stops, such as 0.3");
  }
  if (outside(options.whiteBalanceDrift, 0.5)) {
    return invalid("the white balance's drift is out of range",
                   "choose a share of 0 to 0.5, such as 0.1");
  }
  if (options.rowTime < Duration::zero() ||
      options.rowTime > options.framePeriod / std::max(size.height, 1)) {
    return invalid("the rolling shutter's rows do not fit into the frame period",
                   "choose a row time of 0 to " +
                       std::to_string((options.framePeriod / std::max(size.height, 1)).count()) +
                       " ns");
  }
  return std::nullopt;
}

bool hasFigures(SyntheticShot shot) {
  return shot == SyntheticShot::kVisitors || shot == SyntheticShot::kCrossing ||
         shot == SyntheticShot::kPortrait;
}

}  // namespace

SyntheticCamera::SyntheticCamera(SyntheticOptions options, Clock& clock)
    : options_(options),
      clock_(clock),
      motion_(options.shot, options.seed),
      brightness_(synthetic::mixBits(options.seed) + 21, 1, 5.3),
      balance_(synthetic::mixBits(options.seed) + 22, 1, 7.9),
      sensor_(options.seed, problemOf(options) ? 0 : options.noiseSigma),
      pool_(formatOf(options.size)) {}

CameraIdentity SyntheticCamera::identity() const {
  const std::string shot(toString(options_.shot));
  const std::string seed = std::to_string(options_.seed);
  return {.backend = "synthetic",
          .id = "synthetic:" + shot + ":" + seed,
          .description = "simulated camera before a workbench, shot " + shot + ", seed " + seed};
}

Result<StreamFormat> SyntheticCamera::start(const StreamRequest&) {
  stop();
  if (std::optional<Error> problem = problemOf(options_)) {
    return tl::unexpected(*std::move(problem));
  }
  const FrameSize size = options_.size;
  if (!renderer_) {
    synthetic::WorldOptions world{.seed = options_.seed,
                                  .texelMetres = texelMetresFor(size),
                                  .hasFigures = hasFigures(options_.shot)};
    renderer_.emplace(synthetic::sharedWorkbench(world));
    if (options_.shot == SyntheticShot::kLights) {
      world.hasSpotlight = true;
      spotlitRenderer_.emplace(synthetic::sharedWorkbench(world));
    }
  }
  startTime_ = clock_.now();
  nextSequence_ = 0;
  return StreamFormat{.frame = formatOf(size),
                      .framePeriod = options_.framePeriod,
                      .frameCount = options_.frameCount};
}

void SyntheticCamera::stop() {
  pending_.reset();
}

TimePoint SyntheticCamera::captureTimeOf(std::uint64_t sequence) const {
  return startTime_ + static_cast<Duration::rep>(sequence) * options_.framePeriod;
}

Exposure SyntheticCamera::exposureOf(std::uint64_t sequence) const {
  const Duration time = static_cast<Duration::rep>(sequence) * options_.framePeriod;
  return {options_.size, motion_, time, options_.rowTime};
}

synthetic::SensorGains SyntheticCamera::gainsOf(std::uint64_t sequence) const {
  const double seconds = static_cast<double>(sequence) * toSeconds(options_.framePeriod);
  const double gain = std::exp2(options_.exposureDriftStops * brightness_.at(seconds)) *
                      synthetic::exposureGain(options_.shot, seconds);
  const double warmth = 1 + options_.whiteBalanceDrift * balance_.at(seconds);
  return {gain * warmth, gain, gain / warmth};
}

std::uint64_t SyntheticCamera::dueSequence() const {
  if (options_.pacing == Pacing::kStepped) return nextSequence_;
  const auto now = static_cast<std::uint64_t>((clock_.now() - startTime_) / options_.framePeriod);
  const std::uint64_t newest = options_.frameCount ? std::min(now, *options_.frameCount - 1) : now;
  return std::max(nextSequence_, newest);
}

CapturedFrame SyntheticCamera::capture(std::uint64_t sequence) {
  const std::shared_ptr<Image> image = pool_.take();
  const Exposure exposure = exposureOf(sequence);
  sensor_.beginFrame(sequence, gainsOf(sequence));
  synthetic::Renderer& renderer = synthetic::isSpotlightOn(options_.shot, exposure.secondsAt(0.5))
                                      ? *spotlitRenderer_
                                      : *renderer_;
  renderer.begin(exposure);
  for (int y = 0; y < options_.size.height; ++y) {
    sensor_.exposeRow(y, renderer.nextRow(), image->row(0, y));
  }
  return {.image = image->view(),
          .dmaBufs = {},
          .sequence = sequence,
          .captureTime = captureTimeOf(sequence),
          .timestampSource = TimestampSource::kSimulated,
          .lease = image};
}

NextFrame SyntheticCamera::next(TimePoint deadline) {
  if (!pending_) {
    if (options_.frameCount && nextSequence_ >= *options_.frameCount) return EndOfStream{};
    const std::uint64_t sequence = dueSequence();
    pending_ = capture(sequence);
    pending_->droppedBefore = sequence - nextSequence_;
    nextSequence_ = sequence + 1;
  }
  return takePaced(pending_, options_.pacing, clock_, deadline);
}

GroundTruth SyntheticCamera::truth(std::uint64_t sequence) const {
  return synthetic::truthOf(exposureOf(sequence), synthetic::workbenchGeometry());
}

glm::dmat4 SyntheticCamera::cameraFromWorld(std::uint64_t sequence, int row) const {
  return exposureOf(sequence).viewAt(row + 0.5).cameraFromWorld;
}

FlowVector SyntheticCamera::flow(std::uint64_t from, std::uint64_t to, glm::dvec2 pixel) const {
  return synthetic::flowBetween(exposureOf(from), exposureOf(to), synthetic::workbenchGeometry(),
                                pixel);
}

FlowField SyntheticCamera::flowField(std::uint64_t from, std::uint64_t to, int everyNth) const {
  return synthetic::flowFieldBetween(exposureOf(from), exposureOf(to),
                                     synthetic::workbenchGeometry(), everyNth);
}

MovingMask SyntheticCamera::movingMask(std::uint64_t sequence, int everyNth) const {
  return synthetic::movingMaskOf(exposureOf(sequence), synthetic::workbenchGeometry(), everyNth);
}

}  // namespace pleinair::hal
