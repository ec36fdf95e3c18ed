#include "hal/cameras/libcamera/mapped_buffer.h"

#include <algorithm>
#include <cerrno>

#include <fcntl.h>
#include <linux/dma-buf.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace pleinair::hal::libcamera {

Result<std::shared_ptr<MappedBuffer>> MappedBuffer::map(std::span<const BufferPlane> planes) {
  auto mapped = std::make_shared<MappedBuffer>();
  mapped->memory.planeCount = static_cast<int>(std::min<std::size_t>(planes.size(), 3));
  for (std::size_t i = 0; i < static_cast<std::size_t>(mapped->memory.planeCount); ++i) {
    const BufferPlane& plane = planes[i];
    const std::span<const std::uint8_t> whole = mapped->view(plane.fd);
    if (whole.empty() || plane.offset > whole.size()) {
      return tl::unexpected(
          errnoError({}, "its buffers cannot be mapped", whole.empty() ? errno : EINVAL));
    }
    mapped->memory.planes.at(i) =
        whole.subspan(plane.offset, std::min(plane.length, whole.size() - plane.offset));
    mapped->memory.dmaBufs.at(i) = mapped->descriptors_.at(plane.fd);
    mapped->memory.offsets.at(i) = plane.offset;
  }
  return mapped;
}

MappedBuffer::~MappedBuffer() {
  for (const auto& [fd, bytes] : mappings_) {
    munmap(const_cast<std::uint8_t*>(bytes.data()), bytes.size());
  }
  for (const auto& [fd, own] : descriptors_) close(own);
}

void MappedBuffer::beginRead() const {
  sync(DMA_BUF_SYNC_START);
}

void MappedBuffer::endRead() const {
  sync(DMA_BUF_SYNC_END);
}

void MappedBuffer::sync(std::uint64_t flag) const {
  dma_buf_sync request{};
  request.flags = DMA_BUF_SYNC_READ | flag;
  for (const auto& [fd, own] : descriptors_) {
    while (ioctl(own, DMA_BUF_IOCTL_SYNC, &request) < 0 && (errno == EINTR || errno == EAGAIN)) {
    }
  }
}

std::span<const std::uint8_t> MappedBuffer::view(int fd) {
  if (const auto found = mappings_.find(fd); found != mappings_.end()) return found->second;
  const off_t size = lseek(fd, 0, SEEK_END);
  if (size <= 0) {
    if (size == 0) errno = EINVAL;
    return {};
  }
  const int own = fcntl(fd, F_DUPFD_CLOEXEC, 0);
  if (own < 0) return {};
  const auto bytes = static_cast<std::size_t>(size);
  void* const address = mmap(nullptr, bytes, PROT_READ, MAP_SHARED, own, 0);
  if (address == MAP_FAILED) {
    const int error = errno;
    close(own);
    errno = error;
    return {};
  }
  descriptors_[fd] = own;
  return mappings_[fd] = {static_cast<const std::uint8_t*>(address), bytes};
}

}  // namespace pleinair::hal::libcamera
