#include "hal/frame_memory/shared_frame.h"

#include <cassert>
#include <cerrno>
#include <cstring>
#include <utility>

#include <linux/dma-buf.h>
#include <sys/ioctl.h>
#include <sys/mman.h>

namespace pleinair::hal {
namespace {

/// A multiple of the rows' bytes that every driver takes.
constexpr std::size_t kRowAlignment = 64;

std::array<DmaBufPlane, 3> planesOf(FrameFormat format, std::size_t& bytes) {
  std::array<DmaBufPlane, 3> planes;
  bytes = 0;
  for (int i = 0; i < planeCount(format.pixelFormat); ++i) {
    const std::size_t row = rowBytes(format.pixelFormat, i, format.size.width);
    DmaBufPlane& plane = planes.at(static_cast<std::size_t>(i));
    plane.offsetBytes = bytes;
    plane.strideBytes = (row + kRowAlignment - 1) / kRowAlignment * kRowAlignment;
    bytes += plane.strideBytes *
             static_cast<std::size_t>(planeRows(format.pixelFormat, i, format.size.height));
  }
  return planes;
}

}  // namespace

Result<std::unique_ptr<SharedFrame>> SharedFrame::make(FrameAllocator& allocator,
                                                       FrameFormat format) {
  std::size_t bytes = 0;
  std::array<DmaBufPlane, 3> planes = planesOf(format, bytes);
  Result<FileDescriptor> dmaBuf = allocator.allocate(bytes);
  if (!dmaBuf) return tl::unexpected(std::move(dmaBuf.error()));
  void* const address =
      ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, dmaBuf->get(), 0);
  if (address == MAP_FAILED) {
    return tl::unexpected(errnoError(allocator.name(), "its memory cannot be mapped", errno));
  }
  std::unique_ptr<SharedFrame> frame(
      new SharedFrame(*std::move(dmaBuf), static_cast<std::uint8_t*>(address), bytes));
  for (DmaBufPlane& plane : planes) {
    if (plane.strideBytes > 0) plane.fd = frame->dmaBuf_.get();
  }
  frame->format_ = format;
  frame->planes_ = planes;
  return frame;
}

SharedFrame::SharedFrame(FileDescriptor dmaBuf, std::uint8_t* address, std::size_t bytes)
    : dmaBuf_(std::move(dmaBuf)), address_(address), bytes_(bytes) {}

SharedFrame::~SharedFrame() {
  ::munmap(address_, bytes_);
}

void SharedFrame::write(const ImageView& picture) {
  assert(picture.format == format_);
  dma_buf_sync request{.flags = DMA_BUF_SYNC_WRITE | DMA_BUF_SYNC_START};
  ::ioctl(dmaBuf_.get(), DMA_BUF_IOCTL_SYNC, &request);  // memory without it is coherent
  for (int i = 0; i < planeCount(format_.pixelFormat); ++i) {
    const DmaBufPlane& plane = planes_.at(static_cast<std::size_t>(i));
    for (int y = 0; y < planeRows(format_.pixelFormat, i, format_.size.height); ++y) {
      const std::span<const std::uint8_t> row = picture.row(i, y);
      std::memcpy(address_ + plane.offsetBytes + static_cast<std::size_t>(y) * plane.strideBytes,
                  row.data(), row.size());
    }
  }
  request.flags = DMA_BUF_SYNC_WRITE | DMA_BUF_SYNC_END;
  ::ioctl(dmaBuf_.get(), DMA_BUF_IOCTL_SYNC, &request);
}

CapturedFrame SharedFrame::frame(BufferIdentity identity) const {
  ImageView view{.format = format_, .planes = {}};
  for (int i = 0; i < planeCount(format_.pixelFormat); ++i) {
    const auto at = static_cast<std::size_t>(i);
    view.planes.at(at) = {
        .bytes = {address_ + planes_.at(at).offsetBytes, bytes_ - planes_.at(at).offsetBytes},
        .strideBytes = planes_.at(at).strideBytes};
  }
  return {.image = view,
          .dmaBufs = planes_,
          .buffer = identity,
          .lease = std::make_shared<const BufferIdentity>(identity)};
}

}  // namespace pleinair::hal
