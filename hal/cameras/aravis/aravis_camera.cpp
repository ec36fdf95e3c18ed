#include "hal/cameras/aravis/aravis_camera.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "hal/cameras/aravis/frame_numbers.h"
#include "hal/cameras/aravis/unpack12.h"
#include "hal/frame_pool.h"
#include "hal/image.h"
#include "hal/printable.h"
#include "hal/returned_buffers.h"

namespace pleinair::hal::aravis {
namespace {

using Memory = std::vector<std::uint8_t>;

/// How often the loss of the device is looked for.
constexpr Duration kLossInterval = std::chrono::milliseconds(50);
/// Buffers that Aravis needs: one fills while the packets of the one before are still awaited.
constexpr std::size_t kFewestFree = 2;

/// Tells the camera that a buffer is free when the last copy is dropped; keeps its memory till
/// then.
class Lease {
 public:
  Lease(std::shared_ptr<const Memory> memory, std::shared_ptr<ReturnedBuffers> returns,
        std::uint32_t index)
      : memory_(std::move(memory)), returns_(std::move(returns)), index_(index) {}
  ~Lease() { returns_->put(index_); }
  Lease(const Lease&) = delete;
  Lease& operator=(const Lease&) = delete;

 private:
  std::shared_ptr<const Memory> memory_;
  std::shared_ptr<ReturnedBuffers> returns_;
  std::uint32_t index_;
};

Error named(Error error, const std::string& id) {
  if (error.subject.empty()) error.subject = "aravis:" + id;
  return error;
}

}  // namespace

/// A camera from start() to stop(). One thread; frames may be dropped on any.
class Session {
 public:
  Session(std::string id, std::unique_ptr<Device> device, Clock& clock)
      : id_(std::move(id)),
        clock_(clock),
        numbers_(device->transport()),
        device_(std::move(device)) {}

  std::string description() const { return device_->description(); }
  /// Sets up and starts. Errors: as Camera::start().
  Result<StreamFormat> begin(Library& library, const AravisOptions& options,
                             const StreamRequest& request);
  /// As Camera::next().
  NextFrame next(TimePoint deadline);

 private:
  void requeue();
  std::optional<NextFrame> triggerIfDue();
  std::optional<NextFrame> loss();
  Duration waitUntil(TimePoint deadline) const;
  CapturedFrame frameOf(const Filled& filled);
  /// Whether the buffer holds the whole of an image of the negotiated format.
  bool isWhole(const Filled& filled) const;
  std::size_t strideOf(const Filled& filled) const;
  void lendPixels(const Filled& filled, CapturedFrame& frame);
  void unpackPixels(const Filled& filled, CapturedFrame& frame);
  NextFrame end(NextFrame answer);

  std::string id_;
  Clock& clock_;
  Negotiated negotiated_;
  FrameFormat format_;
  FrameNumbers numbers_;
  std::optional<FramePool> images_;  ///< for copies and unpacked frames
  std::vector<std::shared_ptr<Memory>> memory_;
  std::shared_ptr<ReturnedBuffers> returns_ = std::make_shared<ReturnedBuffers>();
  std::vector<std::uint32_t> returned_;  ///< scratch
  std::size_t lent_ = 0;
  TimePoint nextTrigger_;
  std::optional<NextFrame> ended_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<Stream> stream_;  ///< destroyed first
};

Result<StreamFormat> Session::begin(Library& library, const AravisOptions& options,
                                    const StreamRequest& request) {
  Result<Negotiated> negotiated = setUp(*device_, options, request);
  if (!negotiated) return tl::unexpected(named(std::move(negotiated.error()), id_));
  negotiated_ = *negotiated;
  format_ = {.pixelFormat = negotiated_.layout->pixelFormat, .size = negotiated_.region.size()};
  images_.emplace(format_);
  std::vector<std::span<std::uint8_t>> buffers;
  for (int i = 0; i < options.buffers; ++i) {
    memory_.push_back(std::make_shared<Memory>(negotiated_.bufferBytes));
    buffers.emplace_back(*memory_.back());
  }
  Result<std::unique_ptr<Stream>> stream =
      device_->start({.resends = options.resends,
                      .frameRetention = options.frameRetention,
                      .socketBufferBytes = options.socketBufferBytes,
                      .usesPacketSocket = options.packetSocket},
                     std::move(buffers));
  if (!stream) return tl::unexpected(named(std::move(stream.error()), id_));
  stream_ = *std::move(stream);
  nextTrigger_ = clock_.now();
  return StreamFormat{.frame = format_,
                      .framePeriod = negotiated_.framePeriod,
                      .frameCount = {},
                      .isTriggered = negotiated_.isLineTriggered,
                      .warning = linkWarning(library, *device_, options)};
}

NextFrame Session::end(NextFrame answer) {
  ended_ = std::move(answer);
  return *ended_;
}

void Session::requeue() {
  returned_.clear();
  returns_->take(returned_);
  for (const std::uint32_t index : returned_) {
    --lent_;
    stream_->push(index);
  }
}

std::optional<NextFrame> Session::loss() {
  if (!device_->isLost()) return std::nullopt;
  const bool isNetworked = device_->transport() == Transport::kGige;
  return end(CameraLost{
      .cause = named({.kind = ErrorKind::kDeviceLost,
                      .problem = isNetworked ? "no longer answers on the network" : "is unplugged",
                      .remedy = isNetworked ? "check its cable and its power" : "plug it in again"},
                     id_)});
}

std::optional<NextFrame> Session::triggerIfDue() {
  const TimePoint now = clock_.now();
  if (!negotiated_.isSoftwareTriggered || now < nextTrigger_) return std::nullopt;
  const Duration period = negotiated_.framePeriod.value_or(std::chrono::milliseconds(33));
  nextTrigger_ = std::max(nextTrigger_ + period, now);  // a pause is not made up for
  if (const Result<void> done = device_->trigger(); !done) {
    if (auto lost = loss()) return lost;
    return end(named(done.error(), id_));
  }
  return std::nullopt;
}

Duration Session::waitUntil(TimePoint deadline) const {
  const TimePoint now = clock_.now();
  TimePoint until = std::min(deadline, now + kLossInterval);
  if (negotiated_.isSoftwareTriggered) until = std::min(until, nextTrigger_);
  return std::max(until - now, Duration::zero());
}

NextFrame Session::next(TimePoint deadline) {
  for (;;) {
    if (ended_) return *ended_;
    requeue();
    if (auto failure = triggerIfDue()) return *std::move(failure);
    const std::optional<Filled> filled = stream_->pop(waitUntil(deadline));
    if (!filled) {
      if (auto lost = loss()) return *std::move(lost);
      if (clock_.now() >= deadline) return CameraTimeout{};
    } else if (filled->index >= memory_.size()) {
      continue;  // no buffer of this stream
    } else if (filled->status == BufferStatus::kAborted) {
      stream_->push(filled->index);
    } else {
      return frameOf(*filled);
    }
  }
}

CapturedFrame Session::frameOf(const Filled& filled) {
  CapturedFrame frame;
  numbers_.stamp(filled, stream_->counts(), clock_.now(), frame);
  switch (filled.status) {
    case BufferStatus::kComplete:
      frame.health = isWhole(filled) ? FrameHealth::kValid : FrameHealth::kCorrupt;
      break;
    case BufferStatus::kMissingPackets:
      frame.health = FrameHealth::kIncomplete;
      break;
    default:
      frame.health = FrameHealth::kCorrupt;
  }
  if (negotiated_.layout->packing == Packing::kNone) {
    lendPixels(filled, frame);
  } else {
    unpackPixels(filled, frame);
  }
  return frame;
}

std::size_t Session::strideOf(const Filled& filled) const {
  const auto width = static_cast<std::size_t>(format_.size.width);
  return negotiated_.layout->bytesOf(width) + filled.paddingBytes;
}

bool Session::isWhole(const Filled& filled) const {
  const std::size_t room = memory_[filled.index]->size();
  const auto rows = static_cast<std::size_t>(format_.size.height);
  const std::size_t needed =
      filled.paddingBytes == 0
          ? negotiated_.layout->bytesOf(static_cast<std::size_t>(format_.size.pixels()))
          : strideOf(filled) * rows - filled.paddingBytes;
  return filled.pixelFormat == negotiated_.layout->pfnc && filled.size == format_.size &&
         filled.usedBytes >= needed && filled.offsetBytes <= room &&
         needed <= room - filled.offsetBytes;
}

void Session::lendPixels(const Filled& filled, CapturedFrame& frame) {
  const std::shared_ptr<Memory>& memory = memory_[filled.index];
  // What is not whole has no layout of its own: the frame shows the buffer from its beginning.
  const bool isOwnLayout = isWhole(filled);
  const std::size_t offset = isOwnLayout ? filled.offsetBytes : 0;
  ImageView picture{.format = format_, .planes = {}};
  picture.planes[0] = {.bytes = std::span<const std::uint8_t>(*memory).subspan(offset),
                       .strideBytes = isOwnLayout
                                          ? strideOf(filled)
                                          : rowBytes(format_.pixelFormat, 0, format_.size.width)};
  frame.image = picture;
  const auto index = static_cast<std::uint32_t>(filled.index);
  if (lent_ + 1 + kFewestFree > memory_.size()) {
    const std::shared_ptr<Image> copy = images_->take();
    for (int y = 0; y < format_.size.height; ++y) {
      std::ranges::copy(picture.row(0, y), copy->row(0, y).begin());
    }
    frame.image = copy->view();
    frame.lease = copy;
    stream_->push(index);
    return;
  }
  ++lent_;
  frame.lease = std::make_shared<const Lease>(memory, returns_, index);
}

void Session::unpackPixels(const Filled& filled, CapturedFrame& frame) {
  const std::shared_ptr<Image> image = images_->take();
  const auto unpack = negotiated_.layout->packing == Packing::kLsb12 ? &unpack12p : &unpack12Packed;
  const std::span<const std::uint8_t> all(*memory_[filled.index]);
  if (!isWhole(filled)) {
    unpack(all, image->plane(0));
  } else if (filled.paddingBytes == 0) {  // samples go on across the ends of rows
    unpack(all.subspan(filled.offsetBytes), image->plane(0));
  } else {
    const std::size_t stride = strideOf(filled);
    for (int y = 0; y < format_.size.height; ++y) {
      const std::size_t begin = filled.offsetBytes + static_cast<std::size_t>(y) * stride;
      unpack(all.subspan(begin), image->row(0, y));
    }
  }
  stream_->push(filled.index);
  frame.image = image->view();
  frame.lease = image;
}

AravisCamera::AravisCamera(std::string id, AravisOptions options, Library& library, Clock& clock)
    : options_(std::move(options)),
      library_(library),
      clock_(clock),
      identity_{.backend = "aravis", .id = std::move(id), .description = {}} {
  identity_.description = "machine-vision camera " + identity_.id;
}

AravisCamera::~AravisCamera() = default;

Result<StreamFormat> AravisCamera::start(const StreamRequest& request) {
  stop();
  Result<std::unique_ptr<Device>> device = library_.open(identity_.id);
  if (!device) return tl::unexpected(named(std::move(device.error()), identity_.id));
  auto session = std::make_unique<Session>(identity_.id, *std::move(device), clock_);
  identity_.description = printable(session->description());
  Result<StreamFormat> format = session->begin(library_, options_, request);
  if (format) session_ = std::move(session);
  return format;
}

NextFrame AravisCamera::next(TimePoint deadline) {
  assert(session_ != nullptr && "next() of a camera that does not stream");
  return session_->next(deadline);
}

void AravisCamera::stop() {
  session_.reset();
}

}  // namespace pleinair::hal::aravis
