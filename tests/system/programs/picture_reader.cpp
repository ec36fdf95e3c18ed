// Reads a capture device as a video call does (mapped buffers, one reader that stays), and tells
// when pictures change and, given an input device, when a key of it is pressed. Times are the
// monotonic clock's, in seconds.
//
// usage: picture_reader DEVICE [INPUT]      until SIGTERM
//
//   reads WIDTH HEIGHT FOURCC         once, when it streams
//
//   pressed SECONDS                   the kernel's time of the event
//
//   changed SECONDS LEVELS            the largest mean difference of 16 x 16 bytes, from before
//
//   ended PICTURES LONGEST_WAIT WIDTH HEIGHT FOURCC
#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/input.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/signalfd.h>

namespace {

std::system_error failure(const std::string& what) {
  return {errno, std::generic_category(), what};
}

template <typename T>
void control(int descriptor, unsigned long request, T* value, const char* what) {
  if (::ioctl(descriptor, request, value) < 0) throw failure(what);
}

double now() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

using Bytes = std::vector<std::uint8_t>;

/// Noise of single pixels is no change of the picture, one letter is.
double largestDifference(const Bytes& one, const Bytes& other, std::size_t rowBytes) {
  constexpr std::size_t kSide = 16;
  if (one.size() != other.size() || rowBytes == 0) return 255;
  double largest = 0;
  const std::size_t rows = one.size() / rowBytes;
  for (std::size_t y = 0; y + kSide <= rows; y += kSide) {
    for (std::size_t x = 0; x + kSide <= rowBytes; x += kSide) {
      int sum = 0;
      for (std::size_t i = 0; i < kSide * kSide; ++i) {
        const std::size_t at = (y + i / kSide) * rowBytes + x + i % kSide;
        sum += std::abs(int{one[at]} - int{other[at]});
      }
      largest = std::max(largest, static_cast<double>(sum) / (kSide * kSide));
    }
  }
  return largest;
}

class Reader {
 public:
  explicit Reader(const char* device) : descriptor_(::open(device, O_RDWR | O_NONBLOCK)) {
    if (descriptor_ < 0) throw failure(device);
    rowBytes_ = format().bytesperline;
    v4l2_requestbuffers request{};
    request.count = kBuffers;
    request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    request.memory = V4L2_MEMORY_MMAP;
    control(descriptor_, VIDIOC_REQBUFS, &request, "buffers");
    for (std::uint32_t i = 0; i < request.count; ++i) {
      v4l2_buffer buffer = bufferOf(i);
      control(descriptor_, VIDIOC_QUERYBUF, &buffer, "a buffer");
      void* memory =
          ::mmap(nullptr, buffer.length, PROT_READ, MAP_SHARED, descriptor_, buffer.m.offset);
      if (memory == MAP_FAILED) throw failure("a buffer's memory");
      memory_.push_back({static_cast<const std::uint8_t*>(memory), buffer.length});
      control(descriptor_, VIDIOC_QBUF, &buffer, "to queue a buffer");
    }
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    control(descriptor_, VIDIOC_STREAMON, &type, "to stream");
    waitsSince_ = now();
  }

  int descriptor() const { return descriptor_; }

  std::string formatText() const {
    const v4l2_pix_format pix = format();
    std::array<char, 5> name{};
    std::memcpy(name.data(), &pix.pixelformat, 4);
    return fmt::format("{} {} {}", pix.width, pix.height, name.data());
  }

  void take() {
    constexpr double kChanged = 6;  // of 255
    v4l2_buffer buffer = bufferOf(0);
    if (::ioctl(descriptor_, VIDIOC_DQBUF, &buffer) < 0) {
      if (errno == EAGAIN) return;
      throw failure("a picture");
    }
    const double time = now();
    longestWait_ = std::max(longestWait_, time - waitsSince_);
    waitsSince_ = time;
    const std::span<const std::uint8_t> memory = memory_[buffer.index];
    const auto seen = memory.first(std::min<std::size_t>(buffer.bytesused, memory.size()));
    Bytes picture(seen.begin(), seen.end());
    const double difference = pictures_ == 0 ? 0 : largestDifference(picture, last_, rowBytes_);
    if (difference > kChanged) fmt::print("changed {:.4f} {:.0f}\n", time, difference);
    last_ = std::move(picture);
    ++pictures_;
    control(descriptor_, VIDIOC_QBUF, &buffer, "to queue a buffer");
  }

  void tellEnd() {
    longestWait_ = std::max(longestWait_, now() - waitsSince_);
    fmt::print("ended {} {:.3f} {}\n", pictures_, longestWait_, formatText());
  }

 private:
  static constexpr std::uint32_t kBuffers = 4;

  static v4l2_buffer bufferOf(std::uint32_t index) {
    v4l2_buffer buffer{};
    buffer.index = index;
    buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    buffer.memory = V4L2_MEMORY_MMAP;
    return buffer;
  }
  v4l2_pix_format format() const {
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    control(descriptor_, VIDIOC_G_FMT, &format, "the format");
    return format.fmt.pix;
  }

  int descriptor_;
  std::size_t rowBytes_ = 0;
  std::vector<std::span<const std::uint8_t>> memory_;
  Bytes last_;
  int pictures_ = 0;
  double waitsSince_ = 0;
  double longestWait_ = 0;
};

/// A descriptor of its own beside the program's: both get every event.
int openInput(const char* device) {
  const int descriptor = ::open(device, O_RDONLY | O_NONBLOCK);
  if (descriptor < 0) throw failure(device);
  int clock = CLOCK_MONOTONIC;
  control(descriptor, EVIOCSCLOCKID, &clock, "the clock of events");
  return descriptor;
}

void tellPresses(int input) {
  input_event event{};
  while (::read(input, &event, sizeof event) == sizeof event) {
    if (event.type != EV_KEY || event.value != 1) continue;
    fmt::print("pressed {}.{:06}\n", event.input_event_sec, event.input_event_usec);
  }
}

void read(const char* device, const char* input) {
  sigset_t ending;
  ::sigemptyset(&ending);
  ::sigaddset(&ending, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &ending, nullptr);
  const int signals = ::signalfd(-1, &ending, 0);
  Reader reader(device);
  std::array<pollfd, 3> waited{
      {{.fd = reader.descriptor(), .events = POLLIN, .revents = 0},
       {.fd = signals, .events = POLLIN, .revents = 0},
       {.fd = input == nullptr ? -1 : openInput(input), .events = POLLIN, .revents = 0}}};
  fmt::print("reads {}\n", reader.formatText());
  for (;;) {
    std::fflush(stdout);
    if (::poll(waited.data(), waited.size(), -1) < 0 && errno != EINTR) throw failure("to wait");
    if ((waited[1].revents & POLLIN) != 0) return reader.tellEnd();
    if ((waited[2].revents & POLLIN) != 0) tellPresses(waited[2].fd);
    if ((waited[0].revents & (POLLIN | POLLERR)) != 0) reader.take();
  }
}

}  // namespace

int main(int count, char** values) {
  const std::span arguments(values, static_cast<std::size_t>(count));
  if (arguments.size() != 2 && arguments.size() != 3) return 2;
  try {
    read(arguments[1], arguments.size() == 3 ? arguments[2] : nullptr);
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return EXIT_FAILURE;
  }
}
