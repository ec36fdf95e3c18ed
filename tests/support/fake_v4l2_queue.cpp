// The buffer queue of a fake device, with videobuf2's rules.

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <numeric>

#include "hal/cameras/v4l2/layout.h"
#include "tests/support/fake_v4l2_device.h"
#include "tests/support/test_pictures.h"

namespace pleinair::support {
namespace {

constexpr std::size_t kJpegBytes = 65536;

std::uint32_t u32(std::size_t value) {
  return static_cast<std::uint32_t>(value);
}

}  // namespace

std::vector<std::size_t> FakeV4l2::Device::strides() const {
  const hal::v4l2::Layout* layout = hal::v4l2::findLayout(format().fourcc);
  if (layout == nullptr || layout->isJpeg) return {0};
  const hal::FrameSize now = size.width > 0 ? size : format().sizes.front();
  std::vector<std::size_t> strides;
  for (int plane = 0; plane < hal::planeCount(layout->pixelFormat); ++plane) {
    std::size_t stride = hal::rowBytes(layout->pixelFormat, plane, now.width) + video.rowPadding;
    // In shared memory, I420's chroma stride is half of luma's.
    const bool isHalf =
        layout->memoryPlanes == 1 && plane > 0 && layout->pixelFormat == hal::PixelFormat::kI420;
    if (isHalf) stride = strides.front() / 2;
    strides.push_back(stride);
  }
  return strides;
}

std::vector<std::size_t> FakeV4l2::Device::planeSizes() const {
  const hal::v4l2::Layout* layout = hal::v4l2::findLayout(format().fourcc);
  if (layout == nullptr || layout->isJpeg) return {kJpegBytes};
  const hal::FrameSize now = size.width > 0 ? size : format().sizes.front();
  std::vector<std::size_t> sizes;
  sizes.reserve(static_cast<std::size_t>(hal::planeCount(layout->pixelFormat)));
  for (int plane = 0; plane < hal::planeCount(layout->pixelFormat); ++plane) {
    sizes.push_back(
        strides()[static_cast<std::size_t>(plane)] *
        static_cast<std::size_t>(hal::planeRows(layout->pixelFormat, plane, now.height)));
  }
  if (layout->memoryPlanes == 1) {
    sizes = {std::accumulate(sizes.begin(), sizes.end(), std::size_t{0})};
  }
  return sizes;
}

int FakeV4l2::Device::requestBuffers(int fd, v4l2_requestbuffers& request) {
  const bool isLent = request.memory == V4L2_MEMORY_DMABUF && video.takesLentMemory;
  if (request.type != type() || (request.memory != V4L2_MEMORY_MMAP && !isLent)) return -EINVAL;
  if (owner >= 0 && owner != fd) return -EBUSY;
  if (streaming && request.count > 0) return -EBUSY;
  const bool isMapped = std::ranges::any_of(
      kernel.mapped_, [&](const auto& each) { return each.second.device.get() == this; });
  if (video.keepsMappedBuffers && isMapped && !buffers.empty()) return -EBUSY;
  halt();
  freeBuffers();
  memoryKind = request.memory;
  request.count = std::min(request.count, video.mostBuffers);
  for (std::uint32_t i = 0; i < request.count; ++i) {
    Buffer buffer;
    for (const std::size_t bytes : planeSizes()) {
      if (isLent) {
        buffer.planes.push_back(nullptr);  // it comes with VIDIOC_QBUF
        continue;
      }
      // A little more than needed, because buffers are whole pages.
      const std::size_t room = video.missingBufferBytes > 0
                                   ? bytes - std::min(bytes, video.missingBufferBytes)
                                   : bytes + 64;
      buffer.planes.push_back(std::make_shared<Memory>(room));
      kernel.made_.push_back(buffer.planes.back());
    }
    buffers.push_back(std::move(buffer));
  }
  owner = request.count > 0 ? fd : -1;
  return 0;
}

int FakeV4l2::Device::queryBuffer(v4l2_buffer& buffer) const {
  if (buffer.type != type() || buffer.index >= buffers.size() || memoryKind != V4L2_MEMORY_MMAP) {
    return -EINVAL;
  }
  const auto& planes = buffers[buffer.index].planes;
  // Offsets are cookies made of buffer and plane.
  const auto cookie = [&](std::size_t plane) {
    return u32((std::size_t{buffer.index} * 8 + plane) << 12);
  };
  if (!isMultiPlanar()) {
    buffer.length = u32(planes[0]->size());
    buffer.m.offset = cookie(0);
    return 0;
  }
  if (buffer.length < planes.size() || buffer.m.planes == nullptr) return -EINVAL;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    buffer.m.planes[i].length = u32(planes[i]->size());
    buffer.m.planes[i].m.mem_offset = cookie(i);
  }
  return 0;
}

int FakeV4l2::Device::queue(v4l2_buffer& buffer) {
  if (buffer.type != type() || buffer.memory != memoryKind) return -EINVAL;
  if (buffer.index >= buffers.size()) return -EINVAL;
  if (isMultiPlanar() && buffer.length < buffers[buffer.index].planes.size()) return -EINVAL;
  Buffer& own = buffers[buffer.index];
  if (own.state != BufferState::kDequeued) return -EINVAL;
  if (memoryKind == V4L2_MEMORY_DMABUF) {
    const std::vector<std::size_t> sizes = planeSizes();
    for (std::size_t i = 0; i < own.planes.size(); ++i) {
      const int fd = isMultiPlanar() ? buffer.m.planes[i].m.fd : buffer.m.fd;
      const auto lent = kernel.dmaBufs_.find(fd);
      if (lent == kernel.dmaBufs_.end() || lent->second->size() < sizes[i]) return -EINVAL;
      own.planes[i] = lent->second;
    }
  }
  own.state = BufferState::kQueued;
  queued.push_back(buffer.index);
  return 0;
}

int FakeV4l2::Device::dequeue(v4l2_buffer& buffer) {
  if (buffer.type != type() || buffer.memory != memoryKind || !streaming) return -EINVAL;
  if (done.empty()) return sourceChanging ? -EPIPE : -EAGAIN;
  const std::uint32_t index = done.front();
  done.pop_front();
  Buffer& own = buffers[index];
  own.state = BufferState::kDequeued;
  buffer.index = index;
  buffer.flags = own.flags;
  buffer.sequence = own.sequence;
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(own.timestamp).count();
  buffer.timestamp = {.tv_sec = us / 1'000'000, .tv_usec = us % 1'000'000};
  if (!isMultiPlanar()) {
    buffer.bytesused = own.bytesUsed;
    return 0;
  }
  const std::vector<std::size_t> sizes = planeSizes();
  for (std::size_t i = 0; i < own.planes.size(); ++i) {
    buffer.m.planes[i].bytesused = i == 0 ? own.bytesUsed + own.dataOffset : u32(sizes[i]);
    buffer.m.planes[i].data_offset = i == 0 ? own.dataOffset : 0;
  }
  return 0;
}

int FakeV4l2::Device::exportBuffer(v4l2_exportbuffer& request) {
  if (!video.exportsDmaBufs || memoryKind != V4L2_MEMORY_MMAP) return -ENOTTY;
  if (request.index >= buffers.size() || request.plane >= buffers[request.index].planes.size()) {
    return -EINVAL;
  }
  request.fd = kernel.nextFd_++;
  kernel.dmaBufs_[request.fd] = buffers[request.index].planes[request.plane];
  return 0;
}

int FakeV4l2::Device::switchStream(bool on) {
  if (!on) {
    halt();
    return 0;
  }
  if (buffers.empty()) return -EINVAL;
  streaming = true;
  streamStart = clock.now();
  made = 0;
  sequence = video.firstSequence;
  return 0;
}

void FakeV4l2::Device::halt() {
  streaming = false;
  sourceChanging = false;
  queued.clear();
  done.clear();
  for (Buffer& buffer : buffers) buffer.state = BufferState::kDequeued;
}

void FakeV4l2::Device::freeBuffers() {
  buffers.clear();
  owner = -1;
}

std::optional<hal::TimePoint> FakeV4l2::Device::nextFrameTime() const {
  const bool isStalled = video.stallsAt && made >= *video.stallsAt;
  if (!streaming || isStalled || sourceChanging) return std::nullopt;
  return streamStart + static_cast<hal::Duration::rep>(made + 1) * framePeriod();
}

void FakeV4l2::Device::advance() {
  for (auto time = nextFrameTime(); time && *time <= clock.now(); time = nextFrameTime()) {
    makeFrame(*time);
  }
}

void FakeV4l2::Device::makeFrame(hal::TimePoint time) {
  const auto scripted = video.frames.find(made);
  const FakeFrame script = scripted == video.frames.end() ? FakeFrame{} : scripted->second;
  if (script.changesSourceTo) {
    for (FakeFormat& each : video.formats) each.sizes = {*script.changesSourceTo};
    video.frames.erase(scripted);
    size = {0, 0};
    sourceChanging = true;
    eventPending = eventsWanted;
    return;
  }
  sequence += script.skipped;
  if (!queued.empty()) {
    const std::uint32_t index = queued.front();
    queued.pop_front();
    done.push_back(index);
    Buffer& buffer = buffers[index];
    buffer.state = BufferState::kDone;
    buffer.sequence = sequence;
    buffer.flags = video.timestampFlags | script.addedFlags;
    buffer.timestamp = script.timestamp.value_or(time.time_since_epoch());
    fill(buffer, script);
  }
  ++sequence;
  ++made;
}

void FakeV4l2::Device::fill(Buffer& buffer, const FakeFrame& script) {
  const hal::v4l2::Layout& layout = *hal::v4l2::findLayout(format().fourcc);
  buffer.dataOffset = script.dataOffset.value_or(0);
  if (layout.isJpeg) {
    const std::vector<std::uint8_t>& jpeg = script.jpeg.value_or(video.jpeg);
    std::ranges::copy(jpeg, buffer.planes[0]->begin());  // it may be empty
    buffer.bytesUsed = script.bytesUsed.value_or(u32(jpeg.size()));
    return;
  }
  const hal::Image picture =
      testPicture({.pixelFormat = layout.pixelFormat, .size = size}, static_cast<int>(made));
  const hal::ImageView view = picture.view();
  std::size_t offset = 0;
  for (int plane = 0; plane < hal::planeCount(layout.pixelFormat); ++plane) {
    const auto index = static_cast<std::size_t>(plane);
    const bool isShared = layout.memoryPlanes == 1;
    Memory& memory = *buffer.planes[isShared ? 0 : index];
    if (!isShared) offset = 0;
    if (plane == 0 && buffer.dataOffset < 64) offset = buffer.dataOffset;
    const int rows = hal::planeRows(layout.pixelFormat, plane, size.height);
    for (int y = 0; y < rows; ++y, offset += strides()[index]) {
      const auto row = view.row(plane, y);
      std::memcpy(memory.data() + offset, row.data(), row.size());
    }
  }
  buffer.bytesUsed = script.bytesUsed.value_or(u32(planeSizes()[0]));
}

}  // namespace pleinair::support
