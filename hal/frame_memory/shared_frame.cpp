#include "hal/frame_memory/shared_frame.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <utility>

#include "hal/dma_buf_sync.h"

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
  MappedMemory memory = MappedMemory::map(dmaBuf->get(), bytes, true);
  if (!memory) {
    return tl::unexpected(errnoError(allocator.name(), "its memory cannot be mapped", errno));
  }
  std::unique_ptr<SharedFrame> frame(new SharedFrame(*std::move(dmaBuf), std::move(memory)));
  for (DmaBufPlane& plane : planes) {
    if (plane.strideBytes > 0) plane.fd = frame->dmaBuf_.get();
  }
  frame->format_ = format;
  frame->planes_ = planes;
  return frame;
}

SharedFrame::SharedFrame(FileDescriptor dmaBuf, MappedMemory memory)
    : dmaBuf_(std::move(dmaBuf)), memory_(std::move(memory)) {}

void SharedFrame::write(const ImageView& picture) {
  assert(picture.format == format_);
  syncDmaBuf(dmaBuf_.get(), DmaBufAccess::kBeginWrite);
  for (int i = 0; i < planeCount(format_.pixelFormat); ++i) {
    const DmaBufPlane& plane = planes_.at(static_cast<std::size_t>(i));
    for (int y = 0; y < planeRows(format_.pixelFormat, i, format_.size.height); ++y) {
      const std::span<const std::uint8_t> row = picture.row(i, y);
      std::ranges::copy(
          row, memory_.bytes().begin() +
                   static_cast<std::ptrdiff_t>(plane.offsetBytes +
                                               static_cast<std::size_t>(y) * plane.strideBytes));
    }
  }
  syncDmaBuf(dmaBuf_.get(), DmaBufAccess::kEndWrite);
}

CapturedFrame SharedFrame::frame(BufferIdentity identity) const {
  ImageView view{.format = format_, .planes = {}};
  for (int i = 0; i < planeCount(format_.pixelFormat); ++i) {
    const auto at = static_cast<std::size_t>(i);
    view.planes.at(at) = {.bytes = memory_.bytes().subspan(planes_.at(at).offsetBytes),
                          .strideBytes = planes_.at(at).strideBytes};
  }
  return {.image = view,
          .dmaBufs = planes_,
          .buffer = identity,
          .lease = std::make_shared<const BufferIdentity>(identity)};
}

}  // namespace pleinair::hal
