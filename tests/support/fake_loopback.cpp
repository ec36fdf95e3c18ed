#include "tests/support/fake_loopback.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>

namespace pleinair::support {
namespace {

template <class Argument>
Argument& as(void* argument) {
  return *static_cast<Argument*>(argument);
}

template <std::size_t kSize>
void setText(__u8 (&field)[kSize], const std::string& text) {
  std::copy_n(text.begin(), std::min(text.size(), kSize - 1), field);
}

bool hasLayout(const FakeOutputNode& node, std::uint32_t fourcc) {
  return std::ranges::find(node.layouts, fourcc) != node.layouts.end();
}

std::uint32_t aligned(std::uint32_t value, std::uint32_t to) {
  return (value + to - 1) / to * to;
}

/// Computes strides and sizes from the width, as the drivers do.
v4l2_pix_format worked(const FakeOutputNode& node, v4l2_pix_format pix) {
  pix.width = std::clamp<std::uint32_t>(pix.width, 1, node.maxSide);
  pix.height = std::clamp<std::uint32_t>(pix.height, 1, node.maxSide);
  switch (pix.pixelformat) {
    case V4L2_PIX_FMT_NV12:
    case V4L2_PIX_FMT_YUV420:
      pix.bytesperline = aligned(pix.width, node.alignment);
      pix.sizeimage = pix.bytesperline * pix.height * 3 / 2;
      break;
    case V4L2_PIX_FMT_YUYV:
      pix.bytesperline = aligned(pix.width * 2, node.alignment);
      pix.sizeimage = pix.bytesperline * pix.height;
      break;
    default:
      pix.bytesperline = aligned(pix.width * 4, node.alignment);
      pix.sizeimage = pix.bytesperline * pix.height;
  }
  return pix;
}

int queryCapability(const FakeOutputNode& node, v4l2_capability& answer) {
  if (node.capabilityAnswer != 0) return node.capabilityAnswer;
  answer = {};
  setText(answer.driver, node.driver);
  setText(answer.card, node.card);
  answer.capabilities = node.capabilities | V4L2_CAP_DEVICE_CAPS;
  answer.device_caps = node.capabilities;
  return 0;
}

int enumerate(const FakeOutputNode& node, v4l2_fmtdesc& entry) {
  if (entry.type != V4L2_BUF_TYPE_VIDEO_OUTPUT || !node.listsLayouts) return -EINVAL;
  if (entry.index >= node.layouts.size()) return -EINVAL;
  entry.pixelformat = node.layouts[entry.index];
  return 0;
}

int setFormat(FakeOutputNode& node, v4l2_format& format) {
  if (format.type != V4L2_BUF_TYPE_VIDEO_OUTPUT) return -EINVAL;
  node.asked.push_back(format.fmt.pix);
  if (node.setFormatAnswer != 0) return node.setFormatAnswer;
  if (!node.isHeld) {
    v4l2_pix_format pix = format.fmt.pix;
    const bool isOther = !hasLayout(node, pix.pixelformat);
    if (isOther && node.refusesOthers) return -EINVAL;
    if (isOther) pix.pixelformat = node.otherwise;
    node.format = worked(node, pix);
  }
  format.fmt.pix = node.format;
  constexpr std::uint32_t kPage = 4096;
  if (node.answersPages) format.fmt.pix.sizeimage = aligned(node.format.sizeimage, kPage);
  return 0;
}

}  // namespace

FakeOutputNode* FakeLoopback::of(int fd) {
  const auto descriptor = open_.find(fd);
  if (descriptor == open_.end()) return nullptr;
  const auto found = nodes_.find(descriptor->second);
  return found == nodes_.end() ? nullptr : &found->second;
}

int FakeLoopback::open(const char* path, int flags) {
  const std::lock_guard lock(mutex_);
  const auto found = nodes_.find(path);
  if (found == nodes_.end()) return -ENOENT;
  FakeOutputNode& node = found->second;
  if (node.openAnswer != 0) return node.openAnswer;
  if ((flags & O_NONBLOCK) == 0) node.wasOpenedBlocking = true;
  ++node.openCount;
  ++node.openNow;
  open_[nextDescriptor_] = path;
  return nextDescriptor_++;
}

int FakeLoopback::close(int fd) {
  const std::lock_guard lock(mutex_);
  if (FakeOutputNode* node = of(fd)) --node->openNow;
  return open_.erase(fd) == 1 ? 0 : -EBADF;
}

int FakeLoopback::ioctl(int fd, unsigned long request, void* argument) {
  const std::lock_guard lock(mutex_);
  if (!open_.contains(fd)) return -EBADF;
  FakeOutputNode* node = of(fd);
  if (node == nullptr) return -ENODEV;
  switch (request) {
    case VIDIOC_QUERYCAP:
      return queryCapability(*node, as<v4l2_capability>(argument));
    case VIDIOC_ENUM_FMT:
      return enumerate(*node, as<v4l2_fmtdesc>(argument));
    case VIDIOC_S_FMT:
      return setFormat(*node, as<v4l2_format>(argument));
    case VIDIOC_G_FMT:
      as<v4l2_format>(argument).fmt.pix = node->format;
      return 0;
    case VIDIOC_S_PARM:
      node->rate = as<v4l2_streamparm>(argument).parm.output.timeperframe;
      return 0;
    case VIDIOC_STREAMON:
      if (!node->startsWithoutBuffers) return -EINVAL;
      ++node->startCount;
      return 0;
    case VIDIOC_STREAMOFF:
      ++node->stopCount;
      return 0;
    default:
      return -ENOTTY;
  }
}

int FakeLoopback::map(int, std::size_t, std::int64_t, void*&) {
  return -EINVAL;
}
int FakeLoopback::unmap(void*, std::size_t) {
  return -EINVAL;
}
int FakeLoopback::poll(std::span<pollfd>, std::optional<hal::Duration>) {
  return 0;
}

std::int64_t FakeLoopback::write(int fd, std::span<const std::uint8_t> bytes) {
  const std::lock_guard lock(mutex_);
  if (!open_.contains(fd)) return -EBADF;
  FakeOutputNode* node = of(fd);
  if (node == nullptr) return -ENODEV;
  if (!node->writeAnswers.empty()) {
    const std::int64_t answer = node->writeAnswers.front();
    node->writeAnswers.pop_front();
    if (answer != 0) return answer;
  }
  node->written.emplace_back(bytes.begin(), bytes.end());
  return static_cast<std::int64_t>(bytes.size());
}

}  // namespace pleinair::support
