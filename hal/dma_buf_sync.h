#pragma once

#include <cerrno>
#include <cstdint>

#include <linux/dma-buf.h>
#include <sys/ioctl.h>

namespace pleinair::hal {

/// What the processor begins or ends to do with the memory of a dma-buf.
enum class DmaBufAccess : std::uint64_t {
  kBeginRead = DMA_BUF_SYNC_READ | DMA_BUF_SYNC_START,
  kEndRead = DMA_BUF_SYNC_READ | DMA_BUF_SYNC_END,
  kBeginWrite = DMA_BUF_SYNC_WRITE | DMA_BUF_SYNC_START,
  kEndWrite = DMA_BUF_SYNC_WRITE | DMA_BUF_SYNC_END,
};

/// Brackets an access of the processor (DMA_BUF_IOCTL_SYNC), through `call(fd, request, argument)`,
/// which answers −errno. A call that was interrupted is made again, as the kernel's documentation
/// asks for (dma-buf.h); memory that does not have it is coherent. Any thread.
template <class Call>
void syncDmaBuf(int fd, DmaBufAccess access, Call call) {
  dma_buf_sync request{.flags = static_cast<std::uint64_t>(access)};
  int answer = 0;
  do {
    answer = call(fd, static_cast<unsigned long>(DMA_BUF_IOCTL_SYNC), &request);
  } while (answer == -EINTR || answer == -EAGAIN);
}

/// The same by the system's own call.
inline void syncDmaBuf(int fd, DmaBufAccess access) {
  syncDmaBuf(fd, access, [](int descriptor, unsigned long request, void* argument) {
    return ::ioctl(descriptor, request, argument) < 0 ? -errno : 0;
  });
}

}  // namespace pleinair::hal
