#include "hal/cameras/v4l2/v4l2_camera.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <linux/videodev2.h>

#include "hal/camera.h"
#include "hal/cameras/v4l2/chronology.h"
#include "hal/cameras/v4l2/controls.h"
#include "hal/cameras/v4l2/device.h"
#include "hal/cameras/v4l2/find_device.h"
#include "hal/cameras/v4l2/format.h"
#include "hal/cameras/v4l2/stream.h"
#include "hal/media/motion_jpeg.h"

namespace pleinair::hal::v4l2 {
namespace {

/// The pause before a driver is polled again that signalled readiness but had no buffer.
constexpr Duration kRetryInterval = std::chrono::milliseconds(1);

/// What is taken at a time of events that wait, for drivers that never run out of them. The kernel
/// keeps fewer.
constexpr int kMostEvents = 64;

FrameHealth healthOf(const Filled& filled, const Negotiated& negotiated) {
  if ((filled.flags & V4L2_BUF_FLAG_ERROR) != 0) return FrameHealth::kCorrupt;
  for (int i = 0; i < negotiated.layout->memoryPlanes; ++i) {
    const std::size_t needed =
        neededBytes(negotiated.places, negotiated.stream.frame.pixelFormat, i);
    if (filled.planes.at(static_cast<std::size_t>(i)).usedBytes < needed) {
      return FrameHealth::kIncomplete;
    }
  }
  return FrameHealth::kValid;
}

/// The image that a corrupt frame starts from before the first valid one.
std::shared_ptr<const Image> blackPicture(FrameFormat format) {
  const auto image = std::make_shared<Image>(format);
  for (const int plane : {1, 2}) std::ranges::fill(image->plane(plane), std::uint8_t{128});
  return image;
}

}  // namespace

/// A camera from start() to stop(). One thread; frames may be dropped on any.
class Session {
 public:
  Session(Device device, const StreamRequest& request, std::optional<PowerLine> powerLine,
          Clock& clock);

  /// Sets the controls, negotiates and starts. Errors: as Camera::start().
  Result<StreamFormat> begin();
  /// As Camera::next().
  NextFrame next(TimePoint deadline);

 private:
  /// Processes one event. Gives next()'s answer, or nothing after a spurious wake-up.
  std::optional<NextFrame> step(TimePoint deadline);
  std::optional<NextFrame> readFrame(TimePoint deadline);
  CapturedFrame frameOf(Filled filled);
  /// Resets each pixel offset behind which a whole image has no room to 0. False if there was one.
  bool fitIntoBuffer(Filled& filled) const;
  void lendPixels(const Filled& filled, CapturedFrame& frame);
  void decodePixels(const Filled& filled, CapturedFrame& frame);
  ImageView viewOf(const Filled& filled) const;
  bool isSourceChanged() const;
  Result<void> restart();
  Result<void> startStream();
  std::optional<NextFrame> followSource();
  /// Stores the answer, which every later call repeats.
  NextFrame end(NextFrame answer);
  NextFrame fail(std::string problem, int answer);

  Device device_;
  StreamRequest request_;
  std::optional<PowerLine> powerLine_;
  Clock& clock_;
  Negotiated negotiated_;
  Chronology chronology_;
  std::unique_ptr<Stream> stream_;  ///< destroyed before device_
  bool wasStarving_ = false;
  int requeueFailure_ = 0;                 ///< −errno, reported by the next call
  bool hasFrames_ = false;                 ///< since the device was last started
  std::shared_ptr<const void> lastLease_;  ///< of the last valid JPEG
  ImageView lastPicture_;
  std::optional<NextFrame> ended_;
};

Session::Session(Device device, const StreamRequest& request, std::optional<PowerLine> powerLine,
                 Clock& clock)
    : device_(std::move(device)), request_(request), powerLine_(powerLine), clock_(clock) {}

Result<StreamFormat> Session::begin() {
  if (const Result<void> started = restart(); !started) return tl::unexpected(started.error());
  return negotiated_.stream;
}

Result<void> Session::restart() {
  stream_.reset();
  lastLease_.reset();
  wasStarving_ = false;
  requeueFailure_ = 0;
  hasFrames_ = false;
  chronology_.deviceRestarted();
  Result<Negotiated> negotiated = negotiate(device_, request_);
  if (!negotiated) return tl::unexpected(std::move(negotiated.error()));
  negotiated_ = *std::move(negotiated);
  Result<std::string> differences = setControls(device_, request_.controls, powerLine_);
  if (!differences) return tl::unexpected(std::move(differences.error()));
  negotiated_.stream.warning = *std::move(differences);
  return startStream();
}

/// In lent memory, where there is some and the driver takes it; else in the driver's own.
Result<void> Session::startStream() {
  StreamFormat& format = negotiated_.stream;
  FrameAllocator* const allocator =
      negotiated_.layout->isJpeg ? nullptr : request_.allocator.get();  // JPEGs are decoded
  Result<std::unique_ptr<Stream>> stream = Stream::start(device_, negotiated_, allocator);
  if (!stream && allocator != nullptr) {
    format.memoryNote = stream.error().message();
    stream = Stream::start(device_, negotiated_);
  } else if (allocator != nullptr) {
    format.memoryNote = allocator->name();
  }
  if (!stream) return tl::unexpected(std::move(stream.error()));
  stream_ = *std::move(stream);
  const bool isLent = stream_->buffer(0).isLent;
  const bool isShared = !negotiated_.layout->isJpeg && stream_->hasDmaBufs();
  format.memory = isLent     ? FrameMemory::kLent
                  : isShared ? FrameMemory::kExported
                             : FrameMemory::kProcessor;
  return {};
}

NextFrame Session::end(NextFrame answer) {
  ended_ = std::move(answer);
  return *ended_;
}

NextFrame Session::fail(std::string problem, int answer) {
  Error error = device_.failure(std::move(problem), answer);
  if (!meansLost(answer)) return end(std::move(error));
  error.kind = ErrorKind::kDeviceLost;
  error.remedy = "plug it in again";
  return end(CameraLost{.cause = std::move(error)});
}

NextFrame Session::next(TimePoint deadline) {
  for (;;) {
    if (ended_) return *ended_;
    if (std::optional<NextFrame> answer = step(deadline)) return *std::move(answer);
    if (clock_.now() >= deadline) return CameraTimeout{};  // a source that changes without end
  }
}

std::optional<NextFrame> Session::step(TimePoint deadline) {
  const int returned = std::min(stream_->queueReturned(), requeueFailure_);
  if (returned < 0) return fail("refuses to requeue its buffers", returned);

  std::optional<Duration> timeout;
  if (deadline != kNoDeadline) timeout = std::max(deadline - clock_.now(), Duration::zero());
  pollfd waitFor{.fd = device_.fd(), .events = POLLIN, .revents = 0};
  if (stream_->hasEvents()) waitFor.events |= POLLPRI;
  const int ready = device_.calls().poll({&waitFor, 1}, timeout);
  if (ready < 0) return fail("cannot be polled", ready);
  if (ready == 0) return CameraTimeout{};
  if ((waitFor.revents & POLLPRI) != 0 && isSourceChanged()) return followSource();
  return readFrame(deadline);  // also after POLLERR and POLLHUP: DQBUF gives the error
}

std::optional<NextFrame> Session::readFrame(TimePoint deadline) {
  Filled filled;
  const int answer = stream_->dequeue(filled);
  if (answer == -EAGAIN) {
    const TimePoint now = clock_.now();
    if (now >= deadline) return CameraTimeout{};
    clock_.sleepUntil(std::min(deadline, now + kRetryInterval));  // avoids a busy loop
    return std::nullopt;
  }
  // EPIPE follows the last buffer before a change of source. Before the first frame it means that
  // the driver has no buffers at all.
  if (answer == -EPIPE && hasFrames_) return followSource();
  if (answer < 0) return fail("delivers no more frames", answer);
  hasFrames_ = true;
  return frameOf(filled);
}

bool Session::isSourceChanged() const {
  bool isChanged = false;
  v4l2_event event{};
  for (int i = 0; i < kMostEvents && device_.ask(VIDIOC_DQEVENT, event) >= 0; ++i) {
    isChanged |= event.type == V4L2_EVENT_SOURCE_CHANGE &&
                 (event.u.src_change.changes & V4L2_EVENT_SRC_CH_RESOLUTION) != 0;
    event = {};
  }
  return isChanged;
}

std::optional<NextFrame> Session::followSource() {
  const FrameFormat before = negotiated_.stream.frame;
  if (const Result<void> restarted = restart(); !restarted) {
    const Error& error = restarted.error();
    const bool isLost = error.kind == ErrorKind::kDeviceLost || error.kind == ErrorKind::kNotFound;
    return end(isLost ? NextFrame(CameraLost{.cause = error}) : NextFrame(error));
  }
  if (negotiated_.stream.frame == before) return std::nullopt;
  return FormatChanged{.format = negotiated_.stream};
}

CapturedFrame Session::frameOf(Filled filled) {
  CapturedFrame frame;
  chronology_.stamp(filled, wasStarving_, clock_.now(), frame);
  if (negotiated_.layout->isJpeg) {
    decodePixels(filled, frame);
  } else {
    frame.health = fitIntoBuffer(filled) ? healthOf(filled, negotiated_) : FrameHealth::kCorrupt;
    lendPixels(filled, frame);
  }
  wasStarving_ = stream_->isStarving();
  return frame;
}

bool Session::fitIntoBuffer(Filled& filled) const {
  bool fits = true;
  const Buffer& buffer = stream_->buffer(filled.index);
  for (std::size_t i = 0; i < buffer.planes.size(); ++i) {
    const std::size_t needed =
        neededBytes(negotiated_.places, negotiated_.stream.frame.pixelFormat, static_cast<int>(i));
    const std::size_t room = buffer.planes[i].mapping.bytes().size() - needed;
    if (filled.planes.at(i).offsetBytes <= room) continue;
    filled.planes.at(i).offsetBytes = 0;
    fits = false;
  }
  return fits;
}

ImageView Session::viewOf(const Filled& filled) const {
  ImageView view{.format = negotiated_.stream.frame, .planes = {}};
  const Buffer& buffer = stream_->buffer(filled.index);
  for (int plane = 0; plane < planeCount(view.format.pixelFormat); ++plane) {
    const auto index = static_cast<std::size_t>(plane);
    const PlanePlace& place = negotiated_.places.at(index);
    const auto memoryPlane = static_cast<std::size_t>(place.memoryPlane);
    const std::size_t offset = filled.planes.at(memoryPlane).offsetBytes + place.offsetBytes;
    view.planes.at(index) = {
        .bytes = buffer.planes.at(memoryPlane).mapping.bytes().subspan(offset, place.sizeBytes),
        .strideBytes = place.strideBytes};
  }
  return view;
}

void Session::lendPixels(const Filled& filled, CapturedFrame& frame) {
  const Buffer& buffer = stream_->buffer(filled.index);
  frame.image = FrameImage(viewOf(filled), buffer.access());
  if (stream_->mustKeepTheNext()) {
    const auto copy = std::make_shared<const Image>(frame.image);
    frame.image = copy->view();
    frame.lease = copy;
    requeueFailure_ = stream_->queue(filled.index);
    return;
  }
  frame.lease = stream_->lend(filled.index);
  if (stream_->hasDmaBufs()) frame.buffer = stream_->identityOf(filled.index);
  for (int plane = 0; plane < planeCount(frame.image.format.pixelFormat); ++plane) {
    const auto index = static_cast<std::size_t>(plane);
    const PlanePlace& place = negotiated_.places.at(index);
    const auto memoryPlane = static_cast<std::size_t>(place.memoryPlane);
    const FileDescriptor& dmaBuf = buffer.planes.at(memoryPlane).dmaBuf;
    if (!dmaBuf) continue;
    frame.dmaBufs.at(index) = {
        .fd = dmaBuf.get(),
        .offsetBytes = filled.planes.at(memoryPlane).offsetBytes + place.offsetBytes,
        .strideBytes = place.strideBytes};
  }
}

void Session::decodePixels(const Filled& filled, CapturedFrame& frame) {
  const auto mapped = stream_->buffer(filled.index).planes.at(0).mapping.bytes();
  const Filled::Plane& used = filled.planes[0];
  const std::size_t offset = std::min(used.offsetBytes, mapped.size());
  const auto jpeg = mapped.subspan(offset, std::min(used.usedBytes, mapped.size() - offset));
  Result<libav::LentPicture> picture = libav::decodeMotionJpeg(jpeg, device_.node());
  requeueFailure_ = stream_->queue(filled.index);

  const FrameFormat& format = negotiated_.stream.frame;
  const bool isMarked = (filled.flags & V4L2_BUF_FLAG_ERROR) != 0;
  if (!isMarked && picture && picture->view.format == format) {
    lastPicture_ = picture->view;
    lastLease_ = std::move(picture->lease);
  } else {
    frame.health = FrameHealth::kCorrupt;
  }
  if (!lastLease_) {
    const auto black = blackPicture(format);
    lastPicture_ = black->view();
    lastLease_ = black;
  }
  frame.image = lastPicture_;
  frame.lease = lastLease_;
}

V4l2Camera::V4l2Camera(const std::string& id, System system, Clock& clock, V4l2Options options)
    : system_(system),
      clock_(clock),
      options_(options),
      identity_{.backend = "v4l2", .id = id, .description = "V4L2 camera " + id} {}

V4l2Camera::~V4l2Camera() = default;

CameraIdentity V4l2Camera::identity() const {
  return identity_;
}

Result<StreamFormat> V4l2Camera::start(const StreamRequest& request) {
  stop();
  const Result<std::string> node = findNode(system_, identity_.id);
  if (!node) return tl::unexpected(node.error());
  Result<Device> device = Device::open(system_.calls, *node);
  if (!device) return tl::unexpected(std::move(device.error()));
  identity_.description = device->capability().card + " at " + *node;
  StreamRequest wanted = request;
  std::string problem;
  if (!wanted.allocator && options_.allocator) {
    Result<std::shared_ptr<FrameAllocator>> allocator = openAllocator(*options_.allocator);
    if (allocator) {
      wanted.allocator = *std::move(allocator);
    } else {
      problem = allocator.error().message();
    }
  }
  auto session = std::make_unique<Session>(*std::move(device), wanted, options_.powerLine, clock_);
  Result<StreamFormat> format = session->begin();
  if (!format) return format;
  if (format->memoryNote.empty()) format->memoryNote = std::move(problem);
  session_ = std::move(session);
  return format;
}

NextFrame V4l2Camera::next(TimePoint deadline) {
  assert(session_ != nullptr && "next() of a camera that does not stream");
  return session_->next(deadline);
}

void V4l2Camera::stop() {
  session_.reset();
}

}  // namespace pleinair::hal::v4l2
