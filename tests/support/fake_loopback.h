#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include <linux/videodev2.h>

#include "hal/v4l2/system_calls.h"

namespace pleinair::support {

/// A fake V4L2 output node that behaves like v4l2loopback 0.12 to 0.15 or another driver. Tests set
/// its properties and read the calls that it received.
struct FakeOutputNode {
  // Properties.
  std::string driver = "v4l2 loopback";
  std::string card = "pleinair";
  std::uint32_t capabilities =
      V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_READWRITE | V4L2_CAP_STREAMING;
  std::vector<std::uint32_t> layouts{V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_NV12, V4L2_PIX_FMT_YUV420};
  bool listsLayouts = true;
  /// the answer to a layout that it does not support
  std::uint32_t otherwise = V4L2_PIX_FMT_BGR32;
  bool refusesOthers = false;   ///< EINVAL in place of `otherwise`
  std::uint32_t alignment = 1;  ///< of strides, in bytes
  bool answersPages = true;     ///< VIDIOC_S_FMT's sizeimage is in whole pages (0.12, 0.13)
  std::uint32_t maxSide = 8192;
  bool isHeld = false;  ///< `format` stays, whatever is requested
  v4l2_pix_format format{};
  bool startsWithoutBuffers = true;  ///< VIDIOC_STREAMON without VIDIOC_REQBUFS (before 0.14)

  // Answers in place of the normal ones: −errno.
  int openAnswer = 0;
  int capabilityAnswer = 0;
  int setFormatAnswer = 0;
  std::deque<std::int64_t> writeAnswers;  ///< one per write(); 0: accept

  // Recorded calls.
  std::vector<v4l2_pix_format> asked;              ///< every VIDIOC_S_FMT
  std::vector<std::vector<std::uint8_t>> written;  ///< every frame taken
  v4l2_fract rate{};
  int startCount = 0;
  int stopCount = 0;
  int openCount = 0;
  int openNow = 0;
  bool wasOpenedBlocking = false;
};

/// Fake nodes by their paths; any other path does not exist. Thread-safe, except for the nodes,
/// which tests set up before and read after the run.
class FakeLoopback final : public hal::v4l2::SystemCalls {
 public:
  FakeOutputNode& node(const std::string& path) { return nodes_[path]; }
  void remove(const std::string& path) { nodes_.erase(path); }
  std::size_t openDescriptors() const { return open_.size(); }

  int open(const char* path, int flags) override;
  int close(int fd) override;
  int ioctl(int fd, unsigned long request, void* argument) override;
  int map(int fd, std::size_t length, std::int64_t offset, void*& address) override;
  int unmap(void* address, std::size_t length) override;
  int poll(std::span<pollfd> waitFor, std::optional<hal::Duration> timeout) override;
  std::int64_t write(int fd, std::span<const std::uint8_t> bytes) override;

 private:
  FakeOutputNode* of(int fd);

  std::mutex mutex_;
  std::map<std::string, FakeOutputNode> nodes_;
  std::map<int, std::string> open_;
  int nextDescriptor_ = 1000;
};

}  // namespace pleinair::support
