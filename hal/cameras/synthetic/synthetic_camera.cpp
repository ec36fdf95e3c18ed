#include "hal/cameras/synthetic/synthetic_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <utility>

namespace pleinair::hal {
namespace {

using synthetic::CameraView;
using synthetic::Renderer;

constexpr int kStripPixels = 64;

FrameFormat formatOf(FrameSize size) {
  // The pool wants a size within the limits; start() refuses the others.
  return {.pixelFormat = PixelFormat::kRgb8, .size = isAcceptedSize(size) ? size : FrameSize{1, 1}};
}

/// Half a pixel's footprint or so, as far as memory allows.
double texelMetresFor(FrameSize size) {
  constexpr double kViewingMetres = 0.8;
  constexpr double kFinest = 0.0006;
  constexpr double kCoarsest = 0.004;
  return std::clamp(0.45 * kViewingMetres / syntheticIntrinsics(size).fx, kFinest, kCoarsest);
}

/// The desk of a seed, painted once for all cameras that look at it at a time.
std::shared_ptr<const Renderer> deskOf(std::uint32_t seed, double texelMetres) {
  static std::mutex mutex;
  static std::map<std::pair<std::uint32_t, double>, std::weak_ptr<const Renderer>> desks;
  const std::scoped_lock lock(mutex);
  std::weak_ptr<const Renderer>& known = desks[{seed, texelMetres}];
  if (auto renderer = known.lock()) return renderer;
  auto renderer = std::make_shared<const Renderer>(
      std::make_shared<const synthetic::DeskPicture>(synthetic::paintDesk(seed, texelMetres)));
  known = renderer;
  return renderer;
}

Error refused(ErrorKind kind, std::string problem, std::string remedy) {
  return {.kind = kind,
          .subject = "synthetic camera",
          .problem = std::move(problem),
          .remedy = std::move(remedy)};
}

}  // namespace

SyntheticCamera::SyntheticCamera(SyntheticOptions options, Clock& clock)
    : options_(options),
      clock_(clock),
      path_(options.seed),
      sensor_(options.seed, options.noiseSigma),
      pool_(formatOf(options.size)) {}

CameraIdentity SyntheticCamera::identity() const {
  const std::string seed = std::to_string(options_.seed);
  return {.backend = "synthetic",
          .id = "synthetic:" + seed,
          .description = "simulated camera over a desk with tags, seed " + seed};
}

Result<StreamFormat> SyntheticCamera::start(const StreamRequest&) {
  stop();
  const FrameSize size = options_.size;
  if (!isAcceptedSize(size)) {
    return tl::unexpected(refused(
        ErrorKind::kUnsupported,
        "cannot make frames of " + std::to_string(size.width) + "x" + std::to_string(size.height),
        "choose sides of 1 to " + std::to_string(kMaxSidePixels) + " pixels"));
  }
  if (options_.framePeriod <= Duration::zero()) {
    return tl::unexpected(refused(ErrorKind::kInvalidArgument, "the frame period is not positive",
                                  "choose one such as 33 ms"));
  }
  if (!std::isfinite(options_.noiseSigma) || options_.noiseSigma < 0) {
    return tl::unexpected(refused(ErrorKind::kInvalidArgument,
                                  "the noise is not a number from 0 on",
                                  "choose a standard deviation in 8-bit levels, such as 2"));
  }
  if (!renderer_) renderer_ = deskOf(options_.seed, texelMetresFor(size));
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

CameraView SyntheticCamera::viewOf(std::uint64_t sequence) const {
  const Duration time = static_cast<Duration::rep>(sequence) * options_.framePeriod;
  return {syntheticIntrinsics(options_.size), path_.cameraFromWorld(time)};
}

std::uint64_t SyntheticCamera::dueSequence() const {
  if (options_.pacing == Pacing::kStepped) return nextSequence_;
  const auto now = static_cast<std::uint64_t>((clock_.now() - startTime_) / options_.framePeriod);
  const std::uint64_t newest = options_.frameCount ? std::min(now, *options_.frameCount - 1) : now;
  return std::max(nextSequence_, newest);
}

CapturedFrame SyntheticCamera::capture(std::uint64_t sequence) {
  const std::shared_ptr<Image> image = pool_.take();
  const CameraView view = viewOf(sequence);
  const FrameSize size = options_.size;
  std::array<glm::vec3, kStripPixels> light{};
  // In narrow strips: the part of the desk that a strip's row shows is still cached for the next.
  for (int x = 0; x < size.width; x += kStripPixels) {
    const auto width = static_cast<std::size_t>(std::min(kStripPixels, size.width - x));
    const std::span<glm::vec3> linearRgb(light.data(), width);
    for (int y = 0; y < size.height; ++y) {
      renderer_->renderRun(view, x, y, linearRgb);
      const auto rgb8 = image->row(0, y).subspan(static_cast<std::size_t>(x) * 3, width * 3);
      sensor_.exposeRun(sequence, x, y, linearRgb, rgb8);
    }
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
  if (options_.pacing == Pacing::kRealTime && pending_->captureTime > clock_.now()) {
    clock_.sleepUntil(std::min(pending_->captureTime, deadline));
    if (pending_->captureTime > deadline) return CameraTimeout{};
  }
  CapturedFrame frame = *std::move(pending_);
  pending_.reset();
  return frame;
}

GroundTruth SyntheticCamera::truth(std::uint64_t sequence) const {
  return synthetic::truthOf(viewOf(sequence), options_.size);
}

FlowVector SyntheticCamera::flow(std::uint64_t from, std::uint64_t to, glm::dvec2 pixel) const {
  return synthetic::flowBetween(viewOf(from), viewOf(to), options_.size, pixel);
}

FlowField SyntheticCamera::flowField(std::uint64_t from, std::uint64_t to) const {
  return synthetic::flowFieldBetween(viewOf(from), viewOf(to), options_.size);
}

}  // namespace pleinair::hal
