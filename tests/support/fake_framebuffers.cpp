#include "tests/support/fake_framebuffers.h"

#include <cassert>
#include <cerrno>
#include <cstring>

#include <sys/mman.h>
#include <unistd.h>

namespace pleinair::support {

using hal::display::ObjectId;
using hal::display::ScanOutBuffer;

namespace {

constexpr std::size_t kPixelBytes = 4;

}  // namespace

FakeFramebuffers::~FakeFramebuffers() {
  assert(all_.empty() && "a buffer was left behind");
}

int FakeFramebuffers::create(ObjectId id, hal::FrameSize size, bool isGpu, ScanOutBuffer& buffer) {
  const std::size_t stride = static_cast<std::size_t>(size.width) * kPixelBytes + rowPadding_;
  const std::size_t bytes = stride * static_cast<std::size_t>(size.height);
  if (usedBytes_ + bytes > memoryBytes_) return -ENOMEM;
  const int file = ::memfd_create("scan-out", MFD_CLOEXEC);
  if (file < 0 || ::ftruncate(file, static_cast<off_t>(bytes)) != 0) return -ENOMEM;
  void* memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  assert(memory != MAP_FAILED);
  buffer = {.framebuffer = id,
            .handle = id + 1,
            .dmaBuf = exportsDmaBufs_ ? file : -1,
            .memory = {static_cast<std::uint8_t*>(memory), bytes},
            .strideBytes = stride};
  if (!exportsDmaBufs_) ::close(file);
  all_[id] = {.buffer = buffer, .size = size, .isGpu = isGpu};
  usedBytes_ += bytes;
  return 0;
}

void FakeFramebuffers::destroy(ObjectId id) {
  const auto found = all_.find(id);
  assert(found != all_.end());
  const ScanOutBuffer& buffer = found->second.buffer;
  usedBytes_ -= buffer.memory.size();
  ::munmap(buffer.memory.data(), buffer.memory.size());
  if (buffer.dmaBuf >= 0) ::close(buffer.dmaBuf);
  all_.erase(found);
}

std::uint32_t FakeFramebuffers::pixel(ObjectId id, int x, int y) const {
  const ScanOutBuffer& buffer = all_.at(id).buffer;
  const std::size_t at =
      static_cast<std::size_t>(y) * buffer.strideBytes + static_cast<std::size_t>(x) * kPixelBytes;
  std::uint32_t pixel = 0;
  std::memcpy(&pixel, buffer.memory.data() + at, sizeof(pixel));
  return pixel;
}

void FakeFramebuffers::read(ObjectId id, hal::FrameSize size,
                            std::span<std::uint8_t> pixels) const {
  const ScanOutBuffer& buffer = all_.at(id).buffer;
  const std::size_t rowBytes = static_cast<std::size_t>(size.width) * kPixelBytes;
  for (std::size_t y = 0; y < static_cast<std::size_t>(size.height); ++y) {
    std::memcpy(pixels.data() + y * rowBytes, buffer.memory.data() + y * buffer.strideBytes,
                rowBytes);
  }
}

}  // namespace pleinair::support
