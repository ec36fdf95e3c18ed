#pragma once

// Internal to tests/support/fake_v4l2.h: one device's state.

#include <deque>
#include <memory>
#include <vector>

#include "tests/support/fake_v4l2.h"

namespace pleinair::support {

/// A device between open() and close(), with one queue as in videobuf2. The kernel's lock is held.
struct FakeV4l2::Device {
  Device(FakeVideo given, hal::Clock& time, FakeV4l2& in)
      : video(std::move(given)), clock(time), kernel(in) {}

  enum class BufferState { kDequeued, kQueued, kDone };
  struct Buffer {
    BufferState state = BufferState::kDequeued;
    std::vector<std::shared_ptr<Memory>> planes;
    std::uint32_t flags = 0, sequence = 0, bytesUsed = 0, dataOffset = 0;
    hal::Duration timestamp{0};
  };

  int answer(int fd, unsigned long request, void* argument);
  /// Makes the frames that are due.
  void advance();
  std::optional<hal::TimePoint> nextFrameTime() const;
  bool isMultiPlanar() const { return (video.caps & V4L2_CAP_VIDEO_CAPTURE) == 0; }
  /// Stops streaming and clears the queue.
  void halt();
  void freeBuffers();

  FakeVideo video;
  hal::Clock& clock;
  FakeV4l2& kernel;
  std::optional<int> lost;
  std::size_t formatIndex = 0;
  hal::FrameSize size{0, 0};
  v4l2_fract period{1, 25};
  int owner = -1;
  std::uint32_t memoryKind = V4L2_MEMORY_MMAP;
  std::vector<Buffer> buffers;
  std::deque<std::uint32_t> queued, done;
  bool streaming = false;
  bool sourceChanging = false;
  bool eventPending = false, eventsWanted = false;
  hal::TimePoint streamStart;
  std::uint64_t made = 0;  ///< frames since STREAMON
  std::uint32_t sequence = 0;

 private:
  const FakeFormat& format() const { return video.formats.at(formatIndex); }
  std::uint32_t type() const;
  int queryCapability(v4l2_capability& capability) const;
  int enumerateFormat(v4l2_fmtdesc& entry) const;
  int enumerateSize(v4l2_frmsizeenum& entry) const;
  int enumerateInterval(v4l2_frmivalenum& entry) const;
  int setFormat(v4l2_format& wanted);
  void describeFormat(v4l2_format& answer) const;
  int parameters(v4l2_streamparm& parm, bool set);
  int requestBuffers(int fd, v4l2_requestbuffers& request);
  int queryBuffer(v4l2_buffer& buffer) const;
  int queue(v4l2_buffer& buffer);
  int dequeue(v4l2_buffer& buffer);
  int exportBuffer(v4l2_exportbuffer& request);
  int switchStream(bool on);
  int queryControl(v4l2_queryctrl& query) const;
  int queryMenu(v4l2_querymenu& query) const;
  int setControl(v4l2_control& control);
  int readControl(v4l2_control& control) const;
  FakeControl* control(std::uint32_t id);
  void makeFrame(hal::TimePoint time);
  void fill(Buffer& buffer, const FakeFrame& script);
  std::vector<std::size_t> planeSizes() const;
  std::vector<std::size_t> strides() const;
  hal::Duration framePeriod() const;
};

}  // namespace pleinair::support
