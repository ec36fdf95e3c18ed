#include "hal/cameras/v4l2/buffers.h"

#include <array>
#include <cerrno>
#include <optional>
#include <string>
#include <utility>

#include <fcntl.h>
#include <linux/videodev2.h>

#include "hal/dma_buf_sync.h"

namespace pleinair::hal::v4l2 {
namespace {

/// One buffer for the driver to fill, one queued, and the frames that the program holds at a time.
constexpr std::uint32_t kWantedBuffers = 6;
/// One buffer to fill while the other is read. v4l2loopback gives no more than two by default.
constexpr std::uint32_t kFewestBuffers = 2;

struct PlaneFacts {
  std::size_t length = 0;
  std::int64_t offset = 0;
};

/// Queries the place of the driver's buffer. 0 or −errno.
int queryBuffer(const Device& device, std::uint32_t index, std::size_t planes,
                std::vector<PlaneFacts>& facts) {
  std::array<v4l2_plane, VIDEO_MAX_PLANES> planeInfo{};
  v4l2_buffer buffer{};
  buffer.type = device.bufferType();
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  if (device.isMultiPlanar()) {
    buffer.m.planes = planeInfo.data();
    buffer.length = static_cast<std::uint32_t>(planeInfo.size());
  }
  if (const int answer = device.ask(VIDIOC_QUERYBUF, buffer); answer < 0) return answer;
  facts.clear();
  if (!device.isMultiPlanar()) {
    facts.push_back({.length = buffer.length, .offset = buffer.m.offset});
    return 0;
  }
  for (std::size_t i = 0; i < planes; ++i) {
    facts.push_back({.length = planeInfo.at(i).length, .offset = planeInfo.at(i).m.mem_offset});
  }
  return 0;
}

FileDescriptor exportPlane(const Device& device, std::uint32_t index, std::size_t plane) {
  v4l2_exportbuffer request{};
  request.type = device.bufferType();
  request.index = index;
  request.plane = static_cast<std::uint32_t>(plane);
  request.flags = O_CLOEXEC | O_RDONLY;
  if (device.ask(VIDIOC_EXPBUF, request) < 0) return {};
  return FileDescriptor(request.fd, device.calls());
}

Error tooSmall(const Device& device, std::size_t got, std::size_t needed) {
  return {.kind = ErrorKind::kUnsupported,
          .subject = device.node(),
          .problem = "gives buffers of " + std::to_string(got) + " bytes, where its format needs " +
                     std::to_string(needed),
          .remedy = "ask for another size (camera.size); the driver is inconsistent"};
}

Result<Buffer> mapBuffer(const Device& device, std::uint32_t index,
                         const std::vector<std::size_t>& neededBytes) {
  std::vector<PlaneFacts> facts;
  if (const int answer = queryBuffer(device, index, neededBytes.size(), facts); answer < 0) {
    return tl::unexpected(device.failure("cannot query its buffers", answer));
  }
  Buffer buffer(device.calls());
  for (std::size_t plane = 0; plane < neededBytes.size(); ++plane) {
    const PlaneFacts& fact = facts.at(plane);
    if (fact.length < neededBytes[plane] || fact.length == 0) {
      return tl::unexpected(tooSmall(device, fact.length, neededBytes[plane]));
    }
    void* address = nullptr;
    const int answer = device.calls().map(device.fd(), fact.length, fact.offset, address);
    if (answer < 0) return tl::unexpected(device.failure("cannot map its buffers", answer));
    Mapping mapping(device.calls(), address, fact.length);
    const bool isPicture = neededBytes[plane] > 0;  // compressed: a GPU cannot use a JPEG
    buffer.planes.push_back(
        {.mapping = std::move(mapping),
         .dmaBuf = isPicture ? exportPlane(device, index, plane) : FileDescriptor()});
  }
  return buffer;
}

/// Maps memory of the allocator's, of these sizes.
Result<Buffer> borrowBuffer(const Device& device, FrameAllocator& allocator,
                            const std::vector<std::size_t>& bytes) {
  Buffer buffer(device.calls());
  buffer.isLent = true;
  for (const std::size_t each : bytes) {
    Result<FileDescriptor> dmaBuf = allocator.allocate(each);
    if (!dmaBuf) return tl::unexpected(std::move(dmaBuf.error()));
    void* address = nullptr;
    if (const int answer = device.calls().map(dmaBuf->get(), each, 0, address); answer < 0) {
      return tl::unexpected(
          device.failure("cannot map memory of " + allocator.name() + " for its frames", answer));
    }
    buffer.planes.push_back(
        {.mapping = Mapping(device.calls(), address, each), .dmaBuf = *std::move(dmaBuf)});
  }
  return buffer;
}

void syncAll(const Buffer& buffer, DmaBufAccess access) {
  for (const BufferPlane& plane : buffer.planes) {
    syncDmaBuf(plane.dmaBuf.get(), access, [&](int fd, unsigned long request, void* argument) {
      return buffer.systemCalls->ioctl(fd, request, argument);
    });
  }
}

int requestBuffers(const Device& device, std::uint32_t memory, std::uint32_t& count) {
  v4l2_requestbuffers request{};
  request.type = device.bufferType();
  request.memory = memory;
  request.count = count;
  const int answer = device.ask(VIDIOC_REQBUFS, request);
  count = request.count;
  return answer;
}

Error tooFew(const Device& device, std::uint32_t count) {
  return {.kind = ErrorKind::kUnsupported,
          .subject = device.node(),
          .problem = "gives only " + std::to_string(count) + " buffer" + (count == 1 ? "" : "s") +
                     ", at least " + std::to_string(kFewestBuffers) + " are needed",
          .remedy = "ask for a smaller size (camera.size), or free memory"};
}

}  // namespace

void Buffer::beginRead() const {
  syncAll(*this, DmaBufAccess::kBeginRead);
}

void Buffer::endRead() const {
  syncAll(*this, DmaBufAccess::kEndRead);
}

Result<BufferSet> BufferSet::allocate(const Device& device,
                                      const std::vector<std::size_t>& neededBytes) {
  std::uint32_t count = kWantedBuffers;
  if (const int answer = requestBuffers(device, V4L2_MEMORY_MMAP, count); answer < 0) {
    return tl::unexpected(device.failure("cannot allocate its buffers", answer));
  }
  BufferSet set(device, V4L2_MEMORY_MMAP);  // frees its buffers on each return path
  if (count < kFewestBuffers) return tl::unexpected(tooFew(device, count));
  for (std::uint32_t index = 0; index < count; ++index) {
    Result<Buffer> buffer = mapBuffer(device, index, neededBytes);
    if (!buffer) return tl::unexpected(std::move(buffer.error()));
    set.buffers_.push_back(std::make_shared<const Buffer>(*std::move(buffer)));
  }
  return set;
}

Result<BufferSet> BufferSet::borrow(const Device& device, FrameAllocator& allocator,
                                    const std::vector<std::size_t>& bytes) {
  std::uint32_t count = kWantedBuffers;
  if (const int answer = requestBuffers(device, V4L2_MEMORY_DMABUF, count); answer < 0) {
    Error error = device.failure("takes no memory of others for its frames", answer);
    if (answer == -EINVAL) error.kind = ErrorKind::kUnsupported;
    return tl::unexpected(std::move(error));
  }
  BufferSet set(device, V4L2_MEMORY_DMABUF);
  if (count < kFewestBuffers) return tl::unexpected(tooFew(device, count));
  for (std::uint32_t index = 0; index < count; ++index) {
    Result<Buffer> buffer = borrowBuffer(device, allocator, bytes);
    if (!buffer) return tl::unexpected(std::move(buffer.error()));
    set.buffers_.push_back(std::make_shared<const Buffer>(*std::move(buffer)));
  }
  return set;
}

BufferSet::~BufferSet() {
  if (device_ == nullptr) return;
  buffers_.clear();
  // Leased buffers become orphans. A driver without that feature answers EBUSY and keeps them until
  // the last lease has been dropped.
  std::uint32_t none = 0;
  requestBuffers(*device_, memory_, none);
}

}  // namespace pleinair::hal::v4l2
