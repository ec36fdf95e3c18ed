#include "hal/cameras/libcamera/libcamera_camera.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "hal/cameras/libcamera/frame_layout.h"
#include "hal/cameras/libcamera/settings.h"
#include "hal/frame_pool.h"
#include "hal/printable.h"
#include "hal/returned_buffers.h"

namespace pleinair::hal::libcamera {
namespace {

/// How often the loss of the camera is looked for.
constexpr Duration kLossInterval = std::chrono::milliseconds(50);
/// Buffers that libcamera needs to go on.
constexpr std::size_t kFewestFree = 2;
/// A capture time may lie so far before now; others are taken for those of another clock.
constexpr Duration kOldest = std::chrono::seconds(1);

/// Tells the camera that a buffer is free when the last copy is dropped; keeps its memory till
/// then.
class Lease {
 public:
  Lease(std::shared_ptr<const BufferMemory> memory, std::shared_ptr<ReturnedBuffers> returns,
        std::uint32_t index)
      : memory_(std::move(memory)), returns_(std::move(returns)), index_(index) {}
  ~Lease() { returns_->put(index_); }
  Lease(const Lease&) = delete;
  Lease& operator=(const Lease&) = delete;

 private:
  std::shared_ptr<const BufferMemory> memory_;
  std::shared_ptr<ReturnedBuffers> returns_;
  std::uint32_t index_;
};

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

Error named(Error error, const std::string& id) {
  if (error.subject.empty()) error.subject = "libcamera:" + id;
  return error;
}

}  // namespace

/// A camera from start() to stop(). One thread; frames may be dropped on any.
class Session {
 public:
  Session(std::string id, std::unique_ptr<Device> device, Clock& clock)
      : id_(std::move(id)), clock_(clock), device_(std::move(device)) {}

  std::string description() const { return device_->description(); }
  /// Configures and starts. Errors: as Camera::start().
  Result<StreamFormat> begin(const LibcameraOptions& options, const StreamRequest& request);
  /// As Camera::next().
  NextFrame next(TimePoint deadline);

 private:
  Result<void> configure(const LibcameraOptions& options, const StreamRequest& request);
  bool requeue();
  NextFrame lost();
  NextFrame end(NextFrame answer);
  CapturedFrame frameOf(const Completed& completed);
  void stamp(const Completed& completed, CapturedFrame& frame);
  void lendPixels(const Completed& completed, CapturedFrame& frame);
  void push(std::size_t index);

  std::string id_;
  Clock& clock_;
  StreamAnswer answer_;
  const FrameLayout* layout_ = nullptr;
  FrameFormat format_;
  std::optional<FramePool> images_;  ///< for copies and converted frames
  std::shared_ptr<ReturnedBuffers> returns_ = std::make_shared<ReturnedBuffers>();
  std::vector<std::uint32_t> returned_;  ///< scratch
  std::size_t lent_ = 0;
  std::uint64_t pool_ = 0;
  bool wasStarving_ = false;
  int requeueFailure_ = 0;  ///< −errno
  std::optional<std::uint32_t> lastNumber_;
  std::uint64_t nextSequence_ = 0;
  std::optional<TimePoint> lastTime_;
  std::optional<NextFrame> ended_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<Stream> stream_;  ///< destroyed first
};

Result<void> Session::configure(const LibcameraOptions& options, const StreamRequest& request) {
  const std::vector<OfferedFormat> offered = device_->formats();
  Result<StreamWish> wish = chooseFormat(offered, request.size, request.pixelFormat);
  if (!wish) return tl::unexpected(wish.error());
  wish->buffers = options.buffers;
  wish->orientation = options.orientation;
  const Result<StreamAnswer> answer = device_->configure(*wish);
  if (!answer) return tl::unexpected(answer.error());
  answer_ = *answer;
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

Result<StreamFormat> Session::begin(const LibcameraOptions& options, const StreamRequest& request) {
  if (const Result<void> done = configure(options, request); !done) {
    return tl::unexpected(named(done.error(), id_));
  }
  const Result<StartSettings> settings = settingsFor(*device_, request);
  if (!settings) return tl::unexpected(named(settings.error(), id_));
  format_ = {
      .pixelFormat = layout_->pixelFormat, .size = answer_.size, .encoding = answer_.encoding};
  images_.emplace(format_);
  Result<std::unique_ptr<Stream>> stream = device_->start(*settings);
  if (!stream) return tl::unexpected(named(std::move(stream.error()), id_));
  stream_ = *std::move(stream);
  pool_ = nextBufferPool();
  const bool isShared = layout_->swappedBytes == 0 && stream_->memory(0)->dmaBufs[0] >= 0;
  return StreamFormat{.frame = format_,
                      .framePeriod = settings->framePeriod,
                      .frameCount = {},
                      .memory = isShared ? FrameMemory::kExported : FrameMemory::kProcessor};
}

NextFrame Session::end(NextFrame answer) {
  ended_ = std::move(answer);
  return *ended_;
}

NextFrame Session::lost() {
  return end(CameraLost{.cause = named({.kind = ErrorKind::kDeviceLost,
                                        .problem = stream_->lossText(),
                                        .remedy = "check its cable"},
                                       id_)});
}

void Session::push(std::size_t index) {
  requeueFailure_ = std::min(stream_->push(index), requeueFailure_);
}

bool Session::requeue() {
  returned_.clear();
  returns_->take(returned_);
  for (const std::uint32_t index : returned_) {
    --lent_;
    push(index);
  }
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
      return end(named(errnoError({}, "refuses to requeue its buffers", -requeueFailure_), id_));
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
                         deviceTime >= now - kOldest && (!lastTime_ || deviceTime > *lastTime_);
  frame.captureTime = isTrusted ? deviceTime : now;
  frame.timestampSource = TimestampSource::kEndOfReadout;
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
  if (completed.isFaulty) frame.health = FrameHealth::kCorrupt;
  lendPixels(completed, frame);
  wasStarving_ = lent_ > 0 && lent_ + kFewestFree >= stream_->bufferCount();
  return frame;
}

void Session::lendPixels(const Completed& completed, CapturedFrame& frame) {
  const std::shared_ptr<const BufferMemory> memory = stream_->memory(completed.index);
  const auto planes = planesIn(*memory, *layout_, answer_.size, answer_.strideBytes);
  const bool mustCopy = lent_ + 1 + kFewestFree > stream_->bufferCount();
  if (planes && layout_->swappedBytes == 0 && !mustCopy) {
    frame.image = FrameImage({.format = format_, .planes = *planes}, memory->access);
    frame.dmaBufs = dmaBufsOf(*memory, *planes, planeCount(format_.pixelFormat));
    if (frame.dmaBufs[0].fd >= 0) {
      frame.buffer = {.pool = pool_, .index = static_cast<std::uint32_t>(completed.index)};
    }
    ++lent_;
    frame.lease = std::make_shared<const Lease>(memory, returns_,
                                                static_cast<std::uint32_t>(completed.index));
    return;
  }
  const std::shared_ptr<Image> copy = images_->take();
  if (!planes) {
    frame.health = FrameHealth::kCorrupt;
  } else if (layout_->swappedBytes > 0) {
    const FrameMapping mapped({.format = format_, .planes = *planes}, memory->access);
    swapToRgb(mapped.view().planes[0], layout_->swappedBytes, *copy);
  } else {
    const FrameMapping mapped({.format = format_, .planes = *planes}, memory->access);
    const ImageView& view = mapped.view();
    for (int plane = 0; plane < planeCount(format_.pixelFormat); ++plane) {
      for (int y = 0; y < planeRows(format_.pixelFormat, plane, format_.size.height); ++y) {
        std::ranges::copy(view.row(plane, y), copy->row(plane, y).begin());
      }
    }
  }
  push(completed.index);
  frame.image = copy->view();
  frame.lease = copy;
}

LibcameraCamera::LibcameraCamera(std::string id, LibcameraOptions options, Library& library,
                                 Clock& clock)
    : options_(options),
      library_(library),
      clock_(clock),
      identity_{.backend = "libcamera", .id = std::move(id), .description = {}} {
  identity_.description = "libcamera " + identity_.id;
}

LibcameraCamera::~LibcameraCamera() = default;

Result<StreamFormat> LibcameraCamera::start(const StreamRequest& request) {
  stop();
  Result<std::unique_ptr<Device>> device = library_.open(identity_.id);
  if (!device) return tl::unexpected(named(std::move(device.error()), identity_.id));
  auto session = std::make_unique<Session>(identity_.id, *std::move(device), clock_);
  identity_.description = printable(session->description());
  Result<StreamFormat> format = session->begin(options_, request);
  if (format) session_ = std::move(session);
  return format;
}

NextFrame LibcameraCamera::next(TimePoint deadline) {
  assert(session_ != nullptr && "next() of a camera that does not stream");
  return session_->next(deadline);
}

void LibcameraCamera::stop() {
  session_.reset();
}

}  // namespace pleinair::hal::libcamera
