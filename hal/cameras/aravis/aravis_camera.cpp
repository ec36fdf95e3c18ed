#include "hal/cameras/aravis/aravis_camera.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "hal/buffer_leases.h"
#include "hal/cameras/aravis/frame_numbers.h"
#include "hal/cameras/aravis/unpack12.h"
#include "hal/frame_pool.h"
#include "hal/image.h"
#include "hal/printable.h"

namespace pleinair::hal::aravis {
namespace {

using Memory = std::vector<std::uint8_t>;

/// How often the loss of the device is looked for.
constexpr Duration kLossInterval = std::chrono::milliseconds(50);
/// Buffers that Aravis needs: one fills while the packets of the one before are still awaited.
constexpr std::size_t kFewestFree = 2;

class Session final : public CameraSession {
 public:
  Session(CameraIdentity camera, AravisOptions options, Library& library,
          std::unique_ptr<Device> device, Clock& clock)
      : camera_(std::move(camera)),
        options_(std::move(options)),
        library_(library),
        clock_(clock),
        numbers_(device->transport()),
        device_(std::move(device)) {}

  std::string description() const override { return device_->description(); }
  Result<StreamFormat> begin(const StreamRequest& request) override;
  NextFrame next(TimePoint deadline) override;

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
  Error named(Error error) const { return SessionCamera::named(std::move(error), camera_); }

  CameraIdentity camera_;
  AravisOptions options_;
  Library& library_;
  Clock& clock_;
  Negotiated negotiated_;
  FrameFormat format_;
  FrameNumbers numbers_;
  std::optional<FramePool> images_;  ///< for copies and unpacked frames
  std::vector<std::shared_ptr<Memory>> memory_;
  BufferLeases leases_;
  TimePoint nextTrigger_;
  std::optional<NextFrame> ended_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<Stream> stream_;  ///< destroyed first
};

Result<StreamFormat> Session::begin(const StreamRequest& request) {
  Result<Negotiated> negotiated = setUp(*device_, options_, request);
  if (!negotiated) return tl::unexpected(std::move(negotiated.error()));
  negotiated_ = *negotiated;
  format_ = {.pixelFormat = negotiated_.layout->pixelFormat, .size = negotiated_.region.size()};
  images_.emplace(format_);
  std::vector<std::span<std::uint8_t>> buffers;
  for (int i = 0; i < options_.buffers; ++i) {
    memory_.push_back(std::make_shared<Memory>(negotiated_.bufferBytes));
    buffers.emplace_back(*memory_.back());
  }
  Result<std::unique_ptr<Stream>> stream =
      device_->start({.resends = options_.resends,
                      .frameRetention = options_.frameRetention,
                      .socketBufferBytes = options_.socketBufferBytes,
                      .usesPacketSocket = options_.packetSocket},
                     std::move(buffers));
  if (!stream) return tl::unexpected(std::move(stream.error()));
  stream_ = *std::move(stream);
  std::string warning = linkWarning(library_, *device_, options_);
  if (warning.empty() && !stream_->isGuarded()) {
    warning = "packets that no camera sends are not kept out: use a network of its own";
  }
  nextTrigger_ = clock_.now();
  return StreamFormat{.frame = format_,
                      .framePeriod = negotiated_.framePeriod,
                      .frameCount = {},
                      .isTriggered = negotiated_.isLineTriggered,
                      .warning = std::move(warning)};
}

NextFrame Session::end(NextFrame answer) {
  ended_ = std::move(answer);
  return *ended_;
}

void Session::requeue() {
  leases_.takeBack([this](std::uint32_t index) { stream_->push(index); });
}

std::optional<NextFrame> Session::loss() {
  if (!device_->isLost()) return std::nullopt;
  const bool isNetworked = device_->transport() == Transport::kGige;
  return end(CameraLost{
      .cause =
          named({.kind = ErrorKind::kDeviceLost,
                 .problem = isNetworked ? "no longer answers on the network" : "is unplugged",
                 .remedy = isNetworked ? "check its cable and its power" : "plug it in again"})});
}

std::optional<NextFrame> Session::triggerIfDue() {
  const TimePoint now = clock_.now();
  if (!negotiated_.isSoftwareTriggered || now < nextTrigger_) return std::nullopt;
  const Duration period = negotiated_.framePeriod.value_or(std::chrono::milliseconds(33));
  nextTrigger_ = std::max(nextTrigger_ + period, now);  // a pause is not made up for
  if (const Result<void> done = device_->trigger(); !done) {
    if (auto lost = loss()) return lost;
    return end(named(done.error()));
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
  if (leases_.count() + 1 + kFewestFree > memory_.size()) {
    const std::shared_ptr<Image> copy = images_->take();
    for (int y = 0; y < format_.size.height; ++y) {
      std::ranges::copy(picture.row(0, y), copy->row(0, y).begin());
    }
    frame.image = copy->view();
    frame.lease = copy;
    stream_->push(index);
    return;
  }
  frame.lease = leases_.lend(index, memory);
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

}  // namespace

AravisCamera::AravisCamera(std::string id, AravisOptions options, Library& library, Clock& clock)
    : SessionCamera(
          {.backend = "aravis", .id = id, .description = "machine-vision camera " + printable(id)}),
      id_(std::move(id)),
      options_(std::move(options)),
      library_(library),
      clock_(clock) {}

Result<std::unique_ptr<CameraSession>> AravisCamera::open() {
  Result<std::unique_ptr<Device>> device = library_.open(id_);
  if (!device) return tl::unexpected(std::move(device.error()));
  return std::make_unique<Session>(identity(), options_, library_, *std::move(device), clock_);
}

}  // namespace pleinair::hal::aravis
