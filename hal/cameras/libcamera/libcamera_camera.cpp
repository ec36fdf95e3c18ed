#include "hal/cameras/libcamera/libcamera_camera.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "hal/buffer_leases.h"
#include "hal/cameras/libcamera/frame_layout.h"
#include "hal/cameras/libcamera/settings.h"
#include "hal/frame_pool.h"
#include "hal/printable.h"

namespace pleinair::hal::libcamera {
namespace {

/// How often the loss of the camera is looked for.
constexpr Duration kLossInterval = std::chrono::milliseconds(50);
/// Buffers that libcamera needs to go on.
constexpr std::size_t kFewestFree = 2;
/// A capture time may lie so far before now; others are taken for those of another clock.
constexpr Duration kOldest = std::chrono::seconds(1);

/// Where the planes lie in the dma-bufs of their memory.
std::array<DmaBufPlane, 3> dmaBufsOf(const BufferMemory& memory,
                                     const std::array<PlaneView, 3>& planes, int count) {
  std::array<DmaBufPlane, 3> dmaBufs;
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::size_t in = memory.planeCount >= count ? at : 0;
    const auto begin = planes.at(at).bytes.data() - memory.planes.at(in).data();
    dmaBufs.at(at) = {.fd = memory.dmaBufs.at(in),
                      .offsetBytes = memory.offsets.at(in) + static_cast<std::size_t>(begin),
                      .strideBytes = planes.at(at).strideBytes};
  }
  return dmaBufs;
}

/// Precondition: one format.
void copyRows(const ImageView& from, Image& to) {
  for (int plane = 0; plane < planeCount(from.format.pixelFormat); ++plane) {
    for (int y = 0; y < planeRows(from.format.pixelFormat, plane, from.format.size.height); ++y) {
      std::ranges::copy(from.row(plane, y), to.row(plane, y).begin());
    }
  }
}

/// Why an answer with second images is not to be taken; empty: it is.
std::string lumaProblem(const StreamAnswer& answer, const StreamAnswer& without) {
  if (!answer.luma) return "libcamera makes one image of its frames";
  const FrameSize size = answer.luma->size;
  const FrameLayout* const layout = findLayout(answer.luma->fourcc);
  const bool hasLuma =
      layout != nullptr && std::ranges::count(lumaFourccs(), answer.luma->fourcc) > 0;
  if (!hasLuma) return "its second image has no plane of luma: " + fourccName(answer.luma->fourcc);
  if (!isReduced(size, answer.size)) {
    return "its second image of " + std::to_string(size.width) + "x" + std::to_string(size.height) +
           " px shows another part of the view";
  }
  const bool isSame = answer.fourcc == without.fourcc && answer.size == without.size &&
                      answer.isOrientationKept == without.isOrientationKept;
  return isSame ? "" : "its frames would be others beside a second image";
}

/// The memory of a request's images.
struct Memories {
  std::shared_ptr<const BufferMemory> frame, luma;  ///< luma: null where there is none
  std::shared_ptr<const void> both;                 ///< for leases
};

class Session final : public CameraSession {
 public:
  Session(CameraIdentity camera, LibcameraOptions options, std::unique_ptr<Device> device,
          Clock& clock)
      : camera_(std::move(camera)), options_(options), clock_(clock), device_(std::move(device)) {}

  std::string description() const override { return device_->description(); }
  Result<StreamFormat> begin(const StreamRequest& request) override;
  NextFrame next(TimePoint deadline) override;

 private:
  Result<void> configure(const StreamRequest& request);
  Result<void> configureLuma(StreamWish wish, int sidePx);
  bool requeue();
  NextFrame lost();
  NextFrame end(NextFrame answer);
  CapturedFrame frameOf(const Completed& completed);
  void stamp(const Completed& completed, CapturedFrame& frame);
  void lendPixels(const Completed& completed, CapturedFrame& frame);
  void lend(std::uint32_t index, const std::array<PlaneView, 3>& planes, CapturedFrame& frame);
  std::shared_ptr<Image> copied(const Completed& completed,
                                const std::optional<std::array<PlaneView, 3>>& planes);
  std::optional<ImageView> lumaOf(const Completed& completed, CapturedFrame& frame) const;
  void push(std::size_t index);
  Error named(Error error) const { return SessionCamera::named(std::move(error), camera_); }

  CameraIdentity camera_;
  LibcameraOptions options_;
  Clock& clock_;
  StreamAnswer answer_;
  const FrameLayout* layout_ = nullptr;
  FrameFormat format_;
  std::optional<FramePool> images_;  ///< for copies and converted frames
  const FrameLayout* lumaLayout_ = nullptr;
  std::optional<FrameFormat> lumaFormat_;  ///< of second images; unset: there are none
  std::string lumaNote_;                   ///< why
  std::optional<FramePool> lumaImages_;
  std::vector<Memories> memories_;  ///< by request
  BufferLeases leases_;
  std::uint64_t pool_ = 0;
  bool wasStarving_ = false;
  int requeueFailure_ = 0;  ///< −errno
  std::optional<std::uint32_t> lastNumber_;
  std::uint64_t nextSequence_ = 0;
  std::optional<TimePoint> lastTime_;        ///< captureTime of the last frame
  std::optional<TimePoint> lastDeviceTime_;  ///< the last that was trusted
  std::optional<NextFrame> ended_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<Stream> stream_;  ///< destroyed first
};

Result<void> Session::configure(const StreamRequest& request) {
  const std::vector<OfferedFormat> offered = device_->formats();
  Result<StreamWish> wish = chooseFormat(offered, request.size, request.pixelFormat);
  if (!wish) return tl::unexpected(wish.error());
  wish->buffers = options_.buffers;
  wish->orientation = options_.orientation;
  Result<StreamAnswer> answer = device_->configure(*wish);
  if (!answer) return tl::unexpected(answer.error());
  answer_ = *std::move(answer);
  if (request.lumaSidePx && options_.makesLuma) {
    if (auto done = configureLuma(*wish, *request.lumaSidePx); !done) return done;
  }
  layout_ = findLayout(answer_.fourcc);
  if (layout_ == nullptr) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .problem = "was configured for a pixel format that is not read"});
  }
  if (!isAcceptedSize(answer_.size)) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .problem = "delivers images beyond the limit of " +
                                           std::to_string(kMaxSidePixels) + " px a side",
                                .remedy = "set camera.size"});
  }
  if (!answer_.isOrientationKept) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .problem = "cannot turn its image like that",
                                .remedy = "set camera.libcamera.orientation to upright"});
  }
  return {};
}

/// Asks for second images, too. They must not change the frames.
Result<void> Session::configureLuma(StreamWish wish, int sidePx) {
  wish.fourcc = answer_.fourcc;
  wish.size = answer_.size;
  wish.luma = lumaSizeFor(answer_.size, sidePx);
  if (!wish.luma) {
    lumaNote_ = "its frames are no larger";
    return {};
  }
  Result<StreamAnswer> answer = device_->configure(wish);
  lumaNote_ = answer ? lumaProblem(*answer, answer_) : answer.error().message();
  if (!lumaNote_.empty()) {
    wish.luma.reset();
    answer = device_->configure(wish);
    if (!answer) return tl::unexpected(answer.error());
    answer->luma.reset();
  }
  answer_ = *std::move(answer);
  if (!answer_.luma) return {};
  lumaLayout_ = findLayout(answer_.luma->fourcc);
  lumaFormat_ = {.pixelFormat = PixelFormat::kGrey8, .size = answer_.luma->size};
  lumaImages_.emplace(*lumaFormat_);
  return {};
}

Result<StreamFormat> Session::begin(const StreamRequest& request) {
  if (const Result<void> done = configure(request); !done) return tl::unexpected(done.error());
  const Result<StartSettings> settings = settingsFor(*device_, request);
  if (!settings) return tl::unexpected(settings.error());
  format_ = {
      .pixelFormat = layout_->pixelFormat, .size = answer_.size, .encoding = answer_.encoding};
  images_.emplace(format_);
  Result<std::unique_ptr<Stream>> stream = device_->start(*settings);
  if (!stream) return tl::unexpected(std::move(stream.error()));
  stream_ = *std::move(stream);
  pool_ = nextBufferPool();
  for (std::size_t i = 0; i < stream_->bufferCount(); ++i) {
    Memories memories{.frame = stream_->memory(i),
                      .luma = lumaFormat_ ? stream_->lumaMemory(i) : nullptr};
    memories.both = std::make_shared<const std::array<std::shared_ptr<const BufferMemory>, 2>>(
        std::array{memories.frame, memories.luma});
    memories_.push_back(std::move(memories));
  }
  const bool isShared = layout_->swappedBytes == 0 && stream_->memory(0)->dmaBufs[0] >= 0;
  return StreamFormat{.frame = format_,
                      .framePeriod = settings->framePeriod,
                      .frameCount = {},
                      .memory = isShared ? FrameMemory::kExported : FrameMemory::kProcessor,
                      .luma = lumaFormat_,
                      .lumaNote = lumaNote_};
}

NextFrame Session::end(NextFrame answer) {
  ended_ = std::move(answer);
  return *ended_;
}

NextFrame Session::lost() {
  return end(CameraLost{.cause = named({.kind = ErrorKind::kDeviceLost,
                                        .problem = stream_->lossText(),
                                        .remedy = "check its cable"})});
}

void Session::push(std::size_t index) {
  requeueFailure_ = std::min(stream_->push(index), requeueFailure_);
}

bool Session::requeue() {
  leases_.takeBack([this](std::uint32_t index) { push(index); });
  return requeueFailure_ == 0;
}

NextFrame Session::next(TimePoint deadline) {
  for (;;) {
    if (ended_) return *ended_;
    if (!requeue()) {
      // Since the camera was unplugged, libcamera takes no requests.
      if (stream_->isLost() || requeueFailure_ == -EACCES || requeueFailure_ == -ENODEV) {
        return lost();
      }
      return end(named(errnoError({}, "refuses to requeue its buffers", -requeueFailure_)));
    }
    const TimePoint now = clock_.now();
    const std::optional<Completed> completed =
        stream_->pop(std::max(std::min(deadline, now + kLossInterval) - now, Duration::zero()));
    if (completed && !completed->isCancelled && completed->index < stream_->bufferCount()) {
      return frameOf(*completed);
    }
    if (stream_->isLost()) return lost();
    if (!completed && clock_.now() >= deadline) return CameraTimeout{};
  }
}

void Session::stamp(const Completed& completed, CapturedFrame& frame) {
  const std::uint32_t step = lastNumber_ ? completed.sequence - *lastNumber_ : 1;
  frame.droppedBefore = step == 0 || step > 0x7FFFFFFF ? 0 : step - 1;
  frame.underrunsBefore = wasStarving_ ? frame.droppedBefore : 0;
  frame.sequence = nextSequence_ + frame.droppedBefore;
  lastNumber_ = completed.sequence;
  nextSequence_ = frame.sequence + 1;

  const TimePoint now = clock_.now();
  const TimePoint deviceTime(completed.timestamp);
  const bool isTrusted = completed.timestamp > Duration::zero() && deviceTime <= now &&
                         deviceTime >= now - kOldest &&
                         (!lastDeviceTime_ || deviceTime > *lastDeviceTime_);
  if (isTrusted) lastDeviceTime_ = deviceTime;
  // After a frame of which only the arrival is known, device times lag behind it for a while.
  const bool isBehind = lastTime_ && deviceTime <= *lastTime_;
  frame.captureTime = isTrusted ? deviceTime : now;
  frame.timestampSource =
      isTrusted && !isBehind ? TimestampSource::kEndOfReadout : TimestampSource::kArrival;
  if (lastTime_) frame.captureTime = std::max(frame.captureTime, *lastTime_ + Duration(1));
  lastTime_ = frame.captureTime;
  if (completed.sensorTime) {
    frame.deviceTime = completed.sensorTime;
  } else if (completed.timestamp > Duration::zero()) {
    frame.deviceTime = completed.timestamp;
  }
}

CapturedFrame Session::frameOf(const Completed& completed) {
  CapturedFrame frame;
  stamp(completed, frame);
  lendPixels(completed, frame);
  if (completed.isFaulty) frame.health = FrameHealth::kCorrupt;
  wasStarving_ = leases_.count() > 0 && leases_.count() + kFewestFree >= stream_->bufferCount();
  return frame;
}

/// The second image of a frame, in its own memory. Where it is not as it should be, the frame is
/// not either: trackers would lose what they follow.
std::optional<ImageView> Session::lumaOf(const Completed& completed, CapturedFrame& frame) const {
  const std::shared_ptr<const BufferMemory>& memory = memories_[completed.index].luma;
  if (memory == nullptr) return std::nullopt;
  const auto planes =
      planesIn(*memory, *lumaLayout_, answer_.luma->size, answer_.luma->strideBytes);
  if (!planes) {
    frame.health = FrameHealth::kCorrupt;
    return std::nullopt;
  }
  if (!isFilled(completed.lumaUsedBytes, *memory, *lumaLayout_, *planes)) {
    frame.health = FrameHealth::kIncomplete;
  }
  return ImageView{.format = *lumaFormat_, .planes = {(*planes)[0]}};
}

void Session::lend(std::uint32_t index, const std::array<PlaneView, 3>& planes,
                   CapturedFrame& frame) {
  const BufferMemory& memory = *memories_[index].frame;
  frame.image = FrameImage({.format = format_, .planes = planes}, memory.access);
  frame.dmaBufs = dmaBufsOf(memory, planes, planeCount(format_.pixelFormat));
  if (frame.dmaBufs[0].fd >= 0) frame.buffer = {.pool = pool_, .index = index};
  frame.lease = leases_.lend(index, memories_[index].both);
}

/// The frame in memory of the program's own. Without planes its content is undefined.
std::shared_ptr<Image> Session::copied(const Completed& completed,
                                       const std::optional<std::array<PlaneView, 3>>& planes) {
  std::shared_ptr<Image> copy = images_->take();
  if (!planes) return copy;
  const ReadAccess* const access = memories_[completed.index].frame->access;
  const FrameMapping mapped({.format = format_, .planes = *planes}, access);
  if (layout_->swappedBytes > 0) {
    swapToRgb(mapped.view().planes[0], layout_->swappedBytes, *copy);
  } else {
    copyRows(mapped.view(), *copy);
  }
  return copy;
}

void Session::lendPixels(const Completed& completed, CapturedFrame& frame) {
  const auto index = static_cast<std::uint32_t>(completed.index);
  const BufferMemory& memory = *memories_[index].frame;
  const auto planes = planesIn(memory, *layout_, answer_.size, answer_.strideBytes);
  const std::optional<ImageView> luma = lumaOf(completed, frame);
  if (planes && !isFilled(completed.usedBytes, memory, *layout_, *planes)) {
    frame.health = FrameHealth::kIncomplete;
  }
  if (!planes) frame.health = FrameHealth::kCorrupt;
  const ReadAccess* const lumaAccess = luma ? memories_[index].luma->access : nullptr;
  const bool mustCopy = leases_.count() + 1 + kFewestFree > stream_->bufferCount();
  if (planes && layout_->swappedBytes == 0 && !mustCopy) {
    lend(index, *planes, frame);
    if (luma) frame.luma = FrameImage(*luma, lumaAccess);
    return;
  }
  const std::shared_ptr<Image> copy = copied(completed, planes);
  frame.image = copy->view();
  frame.lease = copy;
  if (luma) {
    const std::shared_ptr<Image> small = lumaImages_->take();
    copyRows(FrameMapping(*luma, lumaAccess).view(), *small);
    frame.luma = small->view();
    frame.lease =
        std::make_shared<const std::array<std::shared_ptr<Image>, 2>>(std::array{copy, small});
  }
  push(completed.index);
}

}  // namespace

LibcameraCamera::LibcameraCamera(std::string id, LibcameraOptions options, Library& library,
                                 Clock& clock)
    : SessionCamera(
          {.backend = "libcamera", .id = id, .description = "libcamera " + printable(id)}),
      id_(std::move(id)),
      options_(options),
      library_(library),
      clock_(clock) {}

Result<std::unique_ptr<CameraSession>> LibcameraCamera::open() {
  Result<std::unique_ptr<Device>> device = library_.open(id_);
  if (!device) return tl::unexpected(std::move(device.error()));
  return std::make_unique<Session>(identity(), options_, *std::move(device), clock_);
}

}  // namespace pleinair::hal::libcamera
