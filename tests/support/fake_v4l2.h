#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <linux/videodev2.h>

#include "hal/cameras/v4l2/device_nodes.h"
#include "hal/clock.h"
#include "hal/frame_allocator.h"
#include "hal/image.h"
#include "hal/v4l2/system_calls.h"

namespace pleinair::support {

/// A pixel format of a fake device, with sizes and rates.
struct FakeFormat {
  std::uint32_t fourcc = V4L2_PIX_FMT_YUYV;
  std::vector<hal::FrameSize> sizes{{64, 48}};
  std::vector<v4l2_fract> periods{{1, 25}};
  /// With a step, `sizes` is a range: any size from its first to its last.
  std::optional<hal::FrameSize> step;
};

struct FakeControl {
  std::uint32_t id = 0;
  int min = 0, max = 100, step = 1, value = 0;
  std::uint32_t flags = 0;
  std::set<std::uint32_t> menu;
  std::optional<int> kept;  ///< what it stays at, whatever is set
};

/// The exceptional properties of one frame. Frames are numbered from 0 at each STREAMON.
struct FakeFrame {
  std::uint32_t skipped = 0;  ///< frames that the device loses before this one
  std::uint32_t addedFlags = 0;
  std::optional<std::uint32_t> bytesUsed;  ///< of the first memory plane
  std::optional<hal::Duration> timestamp;
  std::optional<std::uint32_t> dataOffset;
  std::optional<std::vector<std::uint8_t>> jpeg;
  std::optional<hal::FrameSize> changesSourceTo;  ///< this event comes in place of the frame
};

/// A fake device, as its driver presents it. Frame n holds testPicture(format, n), or `jpeg`.
struct FakeVideo {
  std::string node = "/dev/video0";
  std::string driver = "fake";
  std::string card = "Fake camera";
  std::string bus = "platform:fake-000";
  std::uint32_t caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  std::vector<FakeFormat> formats{FakeFormat{}};
  std::size_t rowPadding = 0;
  bool reportsNoStride = false;
  bool eventsNeverEnd = false;  ///< once there was one
  std::uint32_t colorspace = V4L2_COLORSPACE_SRGB;
  std::uint32_t encoding = 0;
  std::uint32_t quantization = 0;
  std::vector<FakeControl> controls;
  std::uint32_t mostBuffers = 32;
  std::size_t missingBufferBytes = 0;  ///< how much smaller than needed the buffers are
  bool exportsDmaBufs = true;
  bool takesLentMemory = true;  ///< V4L2_MEMORY_DMABUF
  /// behaves like an old driver: REQBUFS(0) is EBUSY while a buffer is mapped
  bool keepsMappedBuffers = false;
  std::uint32_t timestampFlags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  std::uint32_t firstSequence = 0;
  std::vector<std::uint8_t> jpeg;
  std::map<std::uint64_t, FakeFrame> frames;
  std::optional<std::uint64_t> stallsAt;  ///< no frame comes from this one on
  std::map<unsigned long, int> failures;  ///< errno with which a request always fails
  std::optional<int> openFailure;         ///< errno
  int spuriousReadies = 0;                ///< how often poll() reports readiness without an event
  std::function<void(v4l2_format&)> amendFormat;  ///< changes S_FMT's answer last
};

/// A kernel with fake V4L2 devices, as strict about states as videobuf2. Uses `clock`'s time; a
/// wait advances it. Thread-safe; must outlive its users.
class FakeV4l2 final : public hal::v4l2::SystemCalls {
 public:
  explicit FakeV4l2(hal::Clock& clock) : clock_(clock) {}

  /// Replaces the device at the same node. The reference is valid until the device is unplugged.
  FakeVideo& plug(FakeVideo video);
  /// From now on every request to it answers this errno; its node is gone.
  void unplug(const std::string& node, int errnoValue);

  // Resources that have not been released.
  int descriptors() const;  ///< file descriptors of devices
  int dmaBufs() const;
  int mappings() const;
  int buffers() const;  ///< buffers of drivers whose memory is still in use
  /// DMA_BUF_IOCTL_SYNC: reads that were begun, and those of them that have not ended.
  int readsBegun() const;
  int readsGoingOn() const;

  /// Memory to lend to its devices; after `most` buffers there is no more. This outlives it.
  std::shared_ptr<hal::FrameAllocator> allocator(int most = 64);

  int controlValue(const std::string& node, std::uint32_t id) const;
  int opens() const;

  int open(const char* path, int flags) override;
  int close(int fd) override;
  int ioctl(int fd, unsigned long request, void* argument) override;
  int map(int fd, std::size_t length, std::int64_t offset, void*& address) override;
  int unmap(void* address, std::size_t length) override;
  int poll(std::span<pollfd> waitFor, std::optional<hal::Duration> timeout) override;
  std::int64_t write(int fd, std::span<const std::uint8_t> bytes) override;

 private:
  struct Device;
  struct File;
  struct Answerer;
  class Allocator;
  using Memory = std::vector<std::uint8_t>;
  struct Mapped {
    std::shared_ptr<Memory> memory;
    std::shared_ptr<Device> device;
  };

  std::shared_ptr<Device> deviceOf(int fd) const;
  int pollOne(pollfd& waitFor, const Device& device) const;
  int share(std::size_t bytes);
  int sync(const void* argument);

  hal::Clock& clock_;
  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<Device>> devices_;
  std::map<int, std::shared_ptr<Device>> files_;
  std::map<int, std::shared_ptr<Memory>> dmaBufs_;
  std::map<void*, Mapped> mapped_;
  std::vector<std::weak_ptr<Memory>> made_;
  int readsBegun_ = 0, readsEnded_ = 0;
  int nextFd_ = 1000;
  int opens_ = 0;
};

/// Fake folders, links and files.
class FakeNodes final : public hal::v4l2::DeviceNodes {
 public:
  std::map<std::string, std::vector<std::string>> folders;
  std::map<std::string, std::string> links;
  std::map<std::string, std::string> files;

  std::vector<std::string> list(const std::string& folder) override {
    const auto found = folders.find(folder);
    return found == folders.end() ? std::vector<std::string>() : found->second;
  }
  std::optional<std::string> target(const std::string& link) override { return at(links, link); }
  std::optional<std::string> firstLine(const std::string& file) override { return at(files, file); }

 private:
  static std::optional<std::string> at(const std::map<std::string, std::string>& map,
                                       const std::string& key) {
    const auto found = map.find(key);
    return found == map.end() ? std::nullopt : std::optional(found->second);
  }
};

}  // namespace pleinair::support
