#include "hal/outputs/display/gbm_buffers.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <vector>

#include <drm_fourcc.h>
#include <gbm.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include "hal/file_descriptor.h"

namespace pleinair::hal::display {
namespace {

constexpr std::uint32_t kUses = GBM_BO_USE_SCANOUT | GBM_BO_USE_RENDERING;
constexpr std::size_t kBytesOfPixel = 4;

gbm_bo* bufferObject(const GpuBuffer& buffer) {
  return static_cast<gbm_bo*>(buffer.allocation);
}

/// GBM's calls leave errno alone where they fail for reasons of their own.
int failure() {
  return errno != 0 ? -errno : -ENOTSUP;
}

gbm_bo* allocate(gbm_device* device, FrameSize size, std::span<const std::uint64_t> modifiers) {
  const auto width = static_cast<std::uint32_t>(size.width);
  const auto height = static_cast<std::uint32_t>(size.height);
  if (gbm_bo* made = gbm_bo_create_with_modifiers2(
          device, width, height, GBM_FORMAT_XRGB8888, modifiers.data(),
          static_cast<unsigned>(modifiers.size()), kUses)) {
    return made;
  }
  // Drivers without modifiers, software's among them, can be asked for rows one after the other.
  if (std::ranges::find(modifiers, kLinearModifier) == modifiers.end()) return nullptr;
  return gbm_bo_create(device, width, height, GBM_FORMAT_XRGB8888, kUses | GBM_BO_USE_LINEAR);
}

}  // namespace

GbmBuffers::~GbmBuffers() {
  if (device_ != nullptr) gbm_device_destroy(device_);
}

gbm_device* GbmBuffers::device() {
  if (device_ == nullptr) device_ = gbm_create_device(card_);
  return device_;
}

int GbmBuffers::create(FrameSize size, std::span<const std::uint64_t> modifiers,
                       GpuBuffer& buffer) {
  const std::scoped_lock lock(mutex_);
  errno = 0;
  if (device() == nullptr) return -ENOSYS;
  GpuBuffer made;
  gbm_bo* const object = allocate(device_, size, modifiers);
  if (object == nullptr) return failure();
  made.allocation = object;
  const std::uint64_t modifier = gbm_bo_get_modifier(object);
  made.modifier = modifier == DRM_FORMAT_MOD_INVALID ? kLinearModifier : modifier;
  if (const int failed = finish(size, made); failed != 0) {
    for (const SurfacePlane& each : made.planes) {
      if (each.dmaBuf >= 0) systemCloser().close(each.dmaBuf);
    }
    gbm_bo_destroy(object);
    return failed;
  }
  buffer = made;
  return 0;
}

/// The planes of a buffer, and its framebuffer.
int GbmBuffers::finish(FrameSize size, GpuBuffer& buffer) const {
  gbm_bo* const object = bufferObject(buffer);
  buffer.planeCount = gbm_bo_get_plane_count(object);
  if (buffer.planeCount < 1 || buffer.planeCount > 4) return -ENOTSUP;
  std::array<std::uint32_t, 4> handles{};
  std::array<std::uint32_t, 4> strides{};
  std::array<std::uint32_t, 4> offsets{};
  std::array<std::uint64_t, 4> modifiers{};
  for (int i = 0; i < buffer.planeCount; ++i) {
    const auto at = static_cast<std::size_t>(i);
    handles[at] = gbm_bo_get_handle_for_plane(object, i).u32;
    strides[at] = gbm_bo_get_stride_for_plane(object, i);
    offsets[at] = gbm_bo_get_offset(object, i);
    modifiers[at] = buffer.modifier;
    buffer.planes[at] = {.dmaBuf = gbm_bo_get_fd_for_plane(object, i),
                         .offsetBytes = offsets[at],
                         .strideBytes = strides[at]};
    if (buffer.planes[at].dmaBuf < 0) return failure();
  }
  std::uint64_t takesModifiers = 0;
  drmGetCap(card_, DRM_CAP_ADDFB2_MODIFIERS, &takesModifiers);
  const auto width = static_cast<std::uint32_t>(size.width);
  const auto height = static_cast<std::uint32_t>(size.height);
  if (takesModifiers == 1) {
    return drmModeAddFB2WithModifiers(card_, width, height, DRM_FORMAT_XRGB8888, handles.data(),
                                      strides.data(), offsets.data(), modifiers.data(),
                                      &buffer.framebuffer, DRM_MODE_FB_MODIFIERS);
  }
  if (buffer.modifier != kLinearModifier) return -EINVAL;
  return drmModeAddFB2(card_, width, height, DRM_FORMAT_XRGB8888, handles.data(), strides.data(),
                       offsets.data(), &buffer.framebuffer, 0);
}

void GbmBuffers::destroy(const GpuBuffer& buffer) {
  const std::scoped_lock lock(mutex_);
  if (buffer.framebuffer != 0) drmModeRmFB(card_, buffer.framebuffer);
  for (const SurfacePlane& each : buffer.planes) {
    if (each.dmaBuf >= 0) systemCloser().close(each.dmaBuf);
  }
  gbm_bo_destroy(bufferObject(buffer));
}

int GbmBuffers::read(const GpuBuffer& buffer, FrameSize size, std::span<std::uint8_t> pixels) {
  const std::scoped_lock lock(mutex_);
  const std::size_t rowBytes = static_cast<std::size_t>(size.width) * kBytesOfPixel;
  if (pixels.size() < rowBytes * static_cast<std::size_t>(size.height)) return -EINVAL;
  errno = 0;
  std::uint32_t stride = 0;
  void* mapping = nullptr;
  const void* memory =
      gbm_bo_map(bufferObject(buffer), 0, 0, static_cast<std::uint32_t>(size.width),
                 static_cast<std::uint32_t>(size.height), GBM_BO_TRANSFER_READ, &stride, &mapping);
  if (memory == nullptr) return failure();
  const auto* row = static_cast<const std::uint8_t*>(memory);
  for (int y = 0; y < size.height; ++y, row += stride) {
    std::memcpy(pixels.data() + static_cast<std::size_t>(y) * rowBytes, row, rowBytes);
  }
  gbm_bo_unmap(bufferObject(buffer), mapping);
  return 0;
}

std::vector<std::uint64_t> modifiersIn(std::span<const std::uint8_t> inFormats,
                                       std::uint32_t fourcc) {
  std::vector<std::uint64_t> found;
  drm_format_modifier_blob head{};
  if (inFormats.size() < sizeof(head)) return found;
  std::memcpy(&head, inFormats.data(), sizeof(head));
  const auto bytesAt = [&](std::uint64_t offset, std::uint64_t count, std::uint64_t each) {
    const std::uint64_t bytes = count * each;
    const bool isInside = offset <= inFormats.size() && bytes <= inFormats.size() - offset;
    return isInside ? inFormats.subspan(static_cast<std::size_t>(offset),
                                        static_cast<std::size_t>(bytes))
                    : std::span<const std::uint8_t>();
  };
  const auto fourccs = bytesAt(head.formats_offset, head.count_formats, sizeof(std::uint32_t));
  const auto entries =
      bytesAt(head.modifiers_offset, head.count_modifiers, sizeof(drm_format_modifier));
  for (std::size_t at = 0; at + sizeof(drm_format_modifier) <= entries.size();
       at += sizeof(drm_format_modifier)) {
    drm_format_modifier entry{};
    std::memcpy(&entry, entries.data() + at, sizeof(entry));
    // A bit for each of 64 formats from `offset` on.
    for (std::size_t bit = 0; bit < 64; ++bit) {
      const std::size_t index = (entry.offset + bit) * sizeof(std::uint32_t);
      if (((entry.formats >> bit) & 1U) == 0 || index + sizeof(fourcc) > fourccs.size()) continue;
      std::uint32_t listed = 0;
      std::memcpy(&listed, fourccs.data() + index, sizeof(listed));
      if (listed == fourcc) found.push_back(entry.modifier);
    }
  }
  return found;
}

}  // namespace pleinair::hal::display
