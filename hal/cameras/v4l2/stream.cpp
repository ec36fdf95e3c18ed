#include "hal/cameras/v4l2/stream.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <utility>

#include <linux/videodev2.h>

namespace pleinair::hal::v4l2 {
namespace {

/// A v4l2_buffer with the plane array that the multi-planar interface requires.
struct BufferRequest {
  BufferRequest(const Device& device, std::uint32_t memory) {
    buffer.type = device.bufferType();
    buffer.memory = memory;
    if (!device.isMultiPlanar()) return;
    buffer.m.planes = planes.data();
    buffer.length = static_cast<std::uint32_t>(planes.size());
  }
  ~BufferRequest() = default;
  BufferRequest(const BufferRequest&) = delete;
  BufferRequest& operator=(const BufferRequest&) = delete;

  /// Names the memory of a buffer that the driver has not allocated.
  void lend(const Buffer& from, bool isMultiPlanar) {
    if (!isMultiPlanar) {
      buffer.m.fd = from.planes[0].dmaBuf.get();
      buffer.length = static_cast<std::uint32_t>(from.planes[0].mapping.bytes().size());
      return;
    }
    for (std::size_t i = 0; i < from.planes.size(); ++i) {
      planes.at(i).m.fd = from.planes[i].dmaBuf.get();
      planes.at(i).length = static_cast<std::uint32_t>(from.planes[i].mapping.bytes().size());
    }
  }

  v4l2_buffer buffer{};
  std::array<v4l2_plane, VIDEO_MAX_PLANES> planes{};
};

Duration durationOf(const timeval& time) {
  return std::chrono::seconds(time.tv_sec) + std::chrono::microseconds(time.tv_usec);
}

std::vector<std::size_t> neededBytesOf(const Negotiated& negotiated) {
  std::vector<std::size_t> needed;
  needed.reserve(static_cast<std::size_t>(negotiated.layout->memoryPlanes));
  for (int i = 0; i < negotiated.layout->memoryPlanes; ++i) {
    needed.push_back(negotiated.layout->isJpeg
                         ? 0
                         : neededBytes(negotiated.places, negotiated.stream.frame.pixelFormat, i));
  }
  return needed;
}

/// What lent buffers have to hold: what the driver wants, and no less than the format needs.
std::vector<std::size_t> lentBytesOf(const Negotiated& negotiated) {
  std::vector<std::size_t> bytes = neededBytesOf(negotiated);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = std::max(bytes[i], negotiated.imageBytes.at(i));
  }
  return bytes;
}

/// Whether the device reports changes of its source; many lack the event.
bool subscribeToSourceChanges(const Device& device) {
  v4l2_event_subscription subscription{};
  subscription.type = V4L2_EVENT_SOURCE_CHANGE;
  return device.ask(VIDIOC_SUBSCRIBE_EVENT, subscription) >= 0;
}

}  // namespace

Stream::Stream(const Device& device, BufferSet buffers)
    : device_(device), buffers_(std::move(buffers)) {}

Result<std::unique_ptr<Stream>> Stream::start(const Device& device, const Negotiated& negotiated,
                                              FrameAllocator* allocator) {
  Result<BufferSet> buffers = allocator != nullptr
                                  ? BufferSet::borrow(device, *allocator, lentBytesOf(negotiated))
                                  : BufferSet::allocate(device, neededBytesOf(negotiated));
  if (!buffers) return tl::unexpected(std::move(buffers.error()));
  std::unique_ptr<Stream> stream(new Stream(device, *std::move(buffers)));
  for (std::uint32_t index = 0; index < stream->buffers_.count(); ++index) {
    if (const int answer = stream->queue(index); answer < 0) {
      return tl::unexpected(device.failure("refuses to queue its buffers", answer));
    }
  }
  stream->hasEvents_ = subscribeToSourceChanges(device);
  int type = static_cast<int>(device.bufferType());
  if (const int answer = device.ask(VIDIOC_STREAMON, type); answer < 0) {
    return tl::unexpected(device.failure("cannot start streaming", answer));
  }
  return stream;
}

Stream::~Stream() {
  int type = static_cast<int>(device_.bufferType());
  device_.ask(VIDIOC_STREAMOFF, type);  // fails on a lost device, which no longer streams either
}

int Stream::queue(std::uint32_t index) {
  BufferRequest request(device_, buffers_.memory());
  request.buffer.index = index;
  if (buffer(index).isLent) request.lend(buffer(index), device_.isMultiPlanar());
  return device_.ask(VIDIOC_QBUF, request.buffer);
}

int Stream::queueReturned() {
  int failure = 0;
  leases_.takeBack([&](std::uint32_t index) {
    if (const int answer = queue(index); answer < 0) failure = answer;
  });
  return failure;
}

int Stream::dequeue(Filled& filled) {
  BufferRequest request(device_, buffers_.memory());
  if (const int answer = device_.ask(VIDIOC_DQBUF, request.buffer); answer < 0) return answer;
  const v4l2_buffer& buffer = request.buffer;
  // guards against an invalid index from the driver
  if (buffer.index >= buffers_.count()) return -EIO;
  filled = {.index = buffer.index,
            .flags = buffer.flags,
            .sequence = buffer.sequence,
            .timestamp = durationOf(buffer.timestamp),
            .planes = {}};
  if (!device_.isMultiPlanar()) {
    filled.planes[0].usedBytes = buffer.bytesused;
    return 0;
  }
  for (std::size_t i = 0; i < filled.planes.size(); ++i) {
    const v4l2_plane& plane = request.planes.at(i);
    const std::size_t offset = std::min(plane.data_offset, plane.bytesused);
    filled.planes.at(i) = {.offsetBytes = offset, .usedBytes = plane.bytesused - offset};
  }
  return 0;
}

std::shared_ptr<const void> Stream::lend(std::uint32_t index) {
  return leases_.lend(index, buffers_.at(index));
}

}  // namespace pleinair::hal::v4l2
