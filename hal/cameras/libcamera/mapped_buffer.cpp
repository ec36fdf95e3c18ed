#include "hal/cameras/libcamera/mapped_buffer.h"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace pleinair::hal::libcamera {

Result<std::shared_ptr<MappedBuffer>> MappedBuffer::map(std::span<const BufferPlane> planes) {
  auto mapped = std::make_shared<MappedBuffer>();
  mapped->memory.planeCount = static_cast<int>(std::min<std::size_t>(planes.size(), 3));
  for (std::size_t i = 0; i < static_cast<std::size_t>(mapped->memory.planeCount); ++i) {
    const BufferPlane& plane = planes[i];
    const Shared* const shared = mapped->shared(plane.fd);
    if (shared == nullptr || plane.offset > shared->memory.bytes().size()) {
      return tl::unexpected(
          errnoError({}, "its buffers cannot be mapped", shared == nullptr ? errno : EINVAL));
    }
    const std::span<const std::uint8_t> whole = shared->memory.bytes();
    mapped->memory.planes.at(i) =
        whole.subspan(plane.offset, std::min(plane.length, whole.size() - plane.offset));
    mapped->memory.dmaBufs.at(i) = shared->descriptor.get();
    mapped->memory.offsets.at(i) = plane.offset;
  }
  return mapped;
}

void MappedBuffer::beginRead() const {
  sync(DmaBufAccess::kBeginRead);
}

void MappedBuffer::endRead() const {
  sync(DmaBufAccess::kEndRead);
}

void MappedBuffer::sync(DmaBufAccess access) const {
  for (const auto& [fd, shared] : shared_) syncDmaBuf(shared.descriptor.get(), access);
}

const MappedBuffer::Shared* MappedBuffer::shared(int fd) {
  if (const auto found = shared_.find(fd); found != shared_.end()) return &found->second;
  const off_t size = lseek(fd, 0, SEEK_END);
  if (size <= 0) {
    if (size == 0) errno = EINVAL;
    return nullptr;
  }
  Shared own{.descriptor = FileDescriptor(fcntl(fd, F_DUPFD_CLOEXEC, 0)), .memory = {}};
  if (own.descriptor) {
    own.memory = MappedMemory::map(own.descriptor.get(), static_cast<std::size_t>(size));
  }
  if (!own.memory) return nullptr;
  return &shared_.emplace(fd, std::move(own)).first->second;
}

}  // namespace pleinair::hal::libcamera
