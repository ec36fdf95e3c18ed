// Streams from a V4L2 device whose answers are the input: formats, sizes, rates, controls, buffers
// and frames. Whatever it says, frames lie within their memory, errors are lines, and nothing is
// left open.
#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <variant>

#include <linux/videodev2.h>
#include <sys/mman.h>

#include "hal/cameras/v4l2/v4l2_kind.h"
#include "tests/fuzz/bytes.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

using namespace pleinair;
using namespace std::chrono_literals;

constexpr const char* kNode = "/dev/video0";
constexpr std::size_t kMostMapped = 4 << 20;  ///< bytes of a plane
constexpr int kMostMappings = 64;
constexpr int kFrames = 24;

/// A device at /dev/video0.
class InputDevice final : public hal::v4l2::SystemCalls {
 public:
  InputDevice(fuzz::Bytes& input, hal::Clock& clock) : input_(input), clock_(clock) {
    isMultiPlanar_ = input_.once(2);
  }
  ~InputDevice() override {
    if (!open_.empty()) fuzz::fail("a descriptor is left open");
    if (!mapped_.empty()) fuzz::fail("memory is left mapped");
  }

  int open(const char* path, int) override {
    if (std::string_view(path) != kNode) return -ENOENT;
    open_.insert(next_);
    return next_++;
  }
  int close(int fd) override {
    if (open_.erase(fd) == 0) fuzz::fail("a descriptor is closed twice");
    return 0;
  }
  int map(int, std::size_t length, std::int64_t, void*& address) override {
    if (length > kMostMapped || mapped_.size() >= kMostMappings) return -ENOMEM;
    address = ::mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (address == MAP_FAILED) return -ENOMEM;
    const auto content = input_.bytes(input_.once(8) ? 256 : 0);
    std::copy_n(content.begin(), std::min(content.size(), length),
                static_cast<std::uint8_t*>(address));
    mapped_[address] = length;
    return 0;
  }
  int unmap(void* address, std::size_t length) override {
    const auto found = mapped_.find(address);
    if (found == mapped_.end() || found->second != length) fuzz::fail("unmaps what is not mapped");
    mapped_.erase(found);
    return ::munmap(address, length);
  }
  int poll(std::span<pollfd> waitFor, std::optional<hal::Duration> timeout) override {
    clock_.sleepUntil(clock_.now() + std::min(timeout.value_or(40ms), hal::Duration(40ms)));
    // Once the input ends, so does the device: nothing waits for ever.
    if (input_.isEmpty()) return -ENODEV;
    for (pollfd& each : waitFor) {
      each.revents = input_.once(8) ? input_.number<short>() : static_cast<short>(POLLIN);
    }
    return input_.once(16) ? 0 : static_cast<int>(waitFor.size());
  }
  std::int64_t write(int, std::span<const std::uint8_t>) override { return -EINVAL; }

  int ioctl(int fd, unsigned long request, void* argument) override {
    if (!open_.contains(fd)) fuzz::fail("a descriptor that is not open");
    if (input_.once(32)) {
      return -input_.oneOf({EINVAL, EBUSY, EIO, ENODEV, EPIPE, EAGAIN, ENOTTY, ENOLINK, ENOMEM});
    }
    switch (request) {
      case VIDIOC_QUERYCAP:
        return describe(*static_cast<v4l2_capability*>(argument));
      case VIDIOC_ENUM_FMT:
        return describe(*static_cast<v4l2_fmtdesc*>(argument));
      case VIDIOC_ENUM_FRAMESIZES:
        return describe(*static_cast<v4l2_frmsizeenum*>(argument));
      case VIDIOC_ENUM_FRAMEINTERVALS:
        return describe(*static_cast<v4l2_frmivalenum*>(argument));
      case VIDIOC_G_FMT:
      case VIDIOC_S_FMT:
        return amend(*static_cast<v4l2_format*>(argument));
      case VIDIOC_G_PARM:
      case VIDIOC_S_PARM:
        return amend(*static_cast<v4l2_streamparm*>(argument));
      case VIDIOC_QUERYCTRL:
        return describe(*static_cast<v4l2_queryctrl*>(argument));
      case VIDIOC_QUERYMENU:
        return input_.once(2) ? -EINVAL : 0;
      case VIDIOC_S_CTRL:
        return 0;
      case VIDIOC_G_CTRL:
        static_cast<v4l2_control*>(argument)->value = input_.number<std::int32_t>();
        return 0;
      case VIDIOC_REQBUFS:
        return amend(*static_cast<v4l2_requestbuffers*>(argument));
      case VIDIOC_QUERYBUF:
        return place(*static_cast<v4l2_buffer*>(argument));
      case VIDIOC_QBUF:
      case VIDIOC_STREAMON:
      case VIDIOC_STREAMOFF:
      case VIDIOC_SUBSCRIBE_EVENT:
        return 0;
      case VIDIOC_DQBUF:
        return fill(*static_cast<v4l2_buffer*>(argument));
      case VIDIOC_DQEVENT:
        return describe(*static_cast<v4l2_event*>(argument));
      default:
        return -ENOTTY;
    }
  }

 private:
  std::uint32_t any() { return input_.number<std::uint32_t>(); }
  /// Mostly a small number, sometimes any.
  std::uint32_t small() { return input_.once(8) ? any() : input_.number<std::uint8_t>(); }
  std::uint32_t fourcc() {
    return input_.once(16) ? any()
                           : input_.oneOf<std::uint32_t>(
                                 {V4L2_PIX_FMT_NV12, V4L2_PIX_FMT_NV12M, V4L2_PIX_FMT_YUV420,
                                  V4L2_PIX_FMT_YUV420M, V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_RGB24,
                                  V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_SRGGB8, V4L2_PIX_FMT_MJPEG});
  }
  template <std::size_t N>
  void text(__u8 (&into)[N]) {
    const auto bytes = input_.bytes(input_.upTo(N + 1));
    std::copy_n(bytes.begin(), bytes.size(), into);
  }

  int describe(v4l2_capability& capability) {
    text(capability.driver);
    text(capability.card);
    text(capability.bus_info);
    capability.device_caps = V4L2_CAP_STREAMING | (isMultiPlanar_ ? V4L2_CAP_VIDEO_CAPTURE_MPLANE
                                                                  : V4L2_CAP_VIDEO_CAPTURE);
    capability.capabilities = capability.device_caps | V4L2_CAP_DEVICE_CAPS;
    return 0;
  }
  int describe(v4l2_fmtdesc& entry) {
    if (entry.index >= 4) return -EINVAL;
    entry.pixelformat = fourcc();
    return 0;
  }
  int describe(v4l2_frmsizeenum& entry) {
    if (entry.index >= 4) return -EINVAL;
    entry.type = input_.oneOf<std::uint32_t>(
        {V4L2_FRMSIZE_TYPE_DISCRETE, V4L2_FRMSIZE_TYPE_STEPWISE, V4L2_FRMSIZE_TYPE_CONTINUOUS});
    if (entry.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      entry.discrete = {small(), small()};
    } else {
      entry.stepwise = {small(), small(), small(), small(), small(), small()};
    }
    return 0;
  }
  int describe(v4l2_frmivalenum& entry) {
    if (entry.index >= 3) return -EINVAL;
    entry.type =
        input_.oneOf<std::uint32_t>({V4L2_FRMIVAL_TYPE_DISCRETE, V4L2_FRMIVAL_TYPE_STEPWISE});
    entry.stepwise = {{small(), small()}, {small(), small()}, {small(), small()}};
    return 0;
  }
  int describe(v4l2_queryctrl& query) {
    if (input_.once(3)) return -EINVAL;
    query.minimum = input_.number<std::int32_t>();
    query.maximum = input_.number<std::int32_t>();
    query.step = input_.number<std::int32_t>();
    query.flags = input_.once(4) ? any() : 0;
    return 0;
  }
  int describe(v4l2_event& event) {
    if (input_.once(2)) return -ENOENT;
    event.type = V4L2_EVENT_SOURCE_CHANGE;
    event.u.src_change.changes = small();
    return 0;
  }
  int amend(v4l2_format& format) {
    if (isMultiPlanar_) {
      v4l2_pix_format_mplane& pix = format.fmt.pix_mp;
      if (input_.once(4)) pix.pixelformat = fourcc();
      if (input_.once(2)) pix.width = small();
      if (input_.once(2)) pix.height = small();
      if (input_.once(8)) pix.num_planes = input_.number<std::uint8_t>();
      if (input_.once(4)) pix.field = small();
      for (auto& plane : pix.plane_fmt) {
        plane.bytesperline = input_.once(4) ? small() : pix.width;
        plane.sizeimage = input_.once(8) ? any() : plane.bytesperline * pix.height;
      }
      pix.colorspace = small();
      pix.ycbcr_enc = input_.number<std::uint8_t>();
      sizeImage_ = pix.plane_fmt[0].sizeimage;
      return 0;
    }
    v4l2_pix_format& pix = format.fmt.pix;
    if (input_.once(4)) pix.pixelformat = fourcc();
    if (input_.once(2)) pix.width = small();
    if (input_.once(2)) pix.height = small();
    if (input_.once(4)) pix.field = small();
    pix.bytesperline = input_.once(4) ? small() : pix.width;
    pix.sizeimage = input_.once(8) ? any() : 3 * pix.width * pix.height;
    pix.colorspace = small();
    pix.ycbcr_enc = small();
    pix.quantization = small();
    sizeImage_ = pix.sizeimage;
    return 0;
  }
  int amend(v4l2_streamparm& parameters) {
    parameters.parm.capture.capability = V4L2_CAP_TIMEPERFRAME;
    parameters.parm.capture.timeperframe = {small(), small()};
    return 0;
  }
  int amend(v4l2_requestbuffers& request) {
    if (request.count > 0 && input_.once(2)) request.count = small();
    return 0;
  }
  std::uint32_t planeLength() { return input_.once(4) ? any() % (2 * kMostMapped) : sizeImage_; }
  int place(v4l2_buffer& buffer) {
    if (!isMultiPlanar_) {
      buffer.length = planeLength();
      buffer.m.offset = any();
      return 0;
    }
    for (std::uint32_t i = 0; i < std::min<std::uint32_t>(buffer.length, VIDEO_MAX_PLANES); ++i) {
      buffer.m.planes[i].length = planeLength();
      buffer.m.planes[i].m.mem_offset = any();
    }
    return 0;
  }
  int fill(v4l2_buffer& buffer) {
    if (input_.isEmpty()) return -ENODEV;
    buffer.index = input_.once(8) ? any() : static_cast<std::uint32_t>(input_.upTo(6));
    buffer.flags = input_.once(2) ? any() : V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
    buffer.sequence = small();
    buffer.bytesused = input_.once(2) ? any() : sizeImage_;
    buffer.timestamp = {input_.once(4) ? input_.number<std::int64_t>() % 1'000'000'000 : 100,
                        input_.number<std::uint8_t>()};
    if (!isMultiPlanar_) return 0;
    for (std::uint32_t i = 0; i < std::min<std::uint32_t>(buffer.length, VIDEO_MAX_PLANES); ++i) {
      buffer.m.planes[i].bytesused = input_.once(2) ? any() : sizeImage_;
      buffer.m.planes[i].data_offset = input_.once(4) ? any() : 0;
    }
    return 0;
  }

  fuzz::Bytes& input_;
  hal::Clock& clock_;
  bool isMultiPlanar_ = false;
  std::uint32_t sizeImage_ = 0;
  int next_ = 3;
  std::set<int> open_;
  std::map<void*, std::size_t> mapped_;
};

class OneNode final : public hal::v4l2::DeviceNodes {
 public:
  std::vector<std::string> list(const std::string& folder) override {
    return folder == "/dev" ? std::vector<std::string>{"video0"} : std::vector<std::string>();
  }
  std::optional<std::string> target(const std::string&) override { return std::nullopt; }
  std::optional<std::string> firstLine(const std::string&) override { return std::nullopt; }
};

hal::StreamRequest requestOf(fuzz::Bytes& input) {
  hal::StreamRequest request;
  if (input.once(2)) {
    request.size =
        hal::FrameSize{1 + input.number<std::uint8_t>(), 1 + input.number<std::uint8_t>()};
  }
  if (input.once(2)) request.framePeriod = hal::Duration(1 + input.number<std::uint32_t>());
  if (input.once(3)) request.controls.exposure = hal::Duration(input.number<std::int64_t>());
  if (input.once(3)) request.controls.gain = input.number<std::int16_t>() / 1000.0;
  if (input.once(3)) request.controls.focus = hal::Automatic{};
  if (input.once(3)) request.controls.whiteBalance = 1.0 * input.number<std::uint16_t>();
  return request;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes input(data, size);
  hal::SteppedClock clock(hal::TimePoint(100s));
  OneNode nodes;
  InputDevice device(input, clock);
  hal::v4l2::V4l2Options options;
  if (input.once(2)) options.powerLine = hal::v4l2::PowerLine::k50Hz;
  hal::v4l2::V4l2Backend backend({.calls = device, .nodes = nodes}, options);
  const hal::StreamRequest request = requestOf(input);
  if (input.once(4)) static_cast<void>(backend.list());
  if (const auto modes = backend.offeredModes(kNode, request)) {
    fuzz::expectOneLine(modes->chosen.reason);
  }
  const std::unique_ptr<hal::Camera> camera = backend.make(kNode, clock);
  const auto format = camera->start(request);
  if (!format) {
    fuzz::expectOneLine(format.error().message());
    return 0;
  }
  if (!format->warning.empty()) fuzz::expectOneLine(format->warning);
  std::deque<hal::CapturedFrame> held;
  std::optional<hal::TimePoint> last;
  for (int i = 0; i < kFrames; ++i) {
    hal::NextFrame next = camera->next(clock.now() + 100ms);
    auto* const frame = std::get_if<hal::CapturedFrame>(&next);
    if (std::holds_alternative<hal::CameraTimeout>(next) ||
        std::holds_alternative<hal::FormatChanged>(next)) {
      continue;
    }
    if (frame == nullptr) break;
    if (last && frame->captureTime <= *last) fuzz::fail("time does not rise");
    last = frame->captureTime;
    fuzz::touch(frame->image.map().view());
    held.push_back(std::move(*frame));
    if (held.size() > 4) held.pop_front();
  }
  camera->stop();
  for (const hal::CapturedFrame& each : held) fuzz::touch(each.image.map().view());
  return 0;
}
